// What leonav-connect publishes of pages of HAS and PPP-B2b: from lines, and from receivers of
// u-blox and Septentrio.
#include "tools/connect/formats/pages/page_format.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "drivers/b2b/b2b_decoder.h"
#include "drivers/page_lines/page_file_reader.h"
#include "drivers/rinex/navigation_reader.h"
#include "support/catch.h"
#include "support/pages/pages_in_sbf.h"
#include "support/pages/recorded_pages.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"
#include "tools/connect/formats/receivers/sbf_format.h"
#include "tools/connect/formats/receivers/ubx_format.h"

namespace leonav {
namespace {

using test::kB2bPages;
using test::kBroadcast;
using test::kHasPages;
constexpr const char* kWalk = "walk/gnss.ubx";

struct Counts : MessageTarget {
  void take(Channel channel, ByteSpan bytes) override {
    ++of[channel];
    all.emplace_back(bytes.begin(), bytes.end());
  }
  std::map<Channel, int> of;
  std::vector<std::vector<std::uint8_t>> all;
};

std::vector<std::uint8_t> bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void feed(StreamFormat* format, std::span<const std::uint8_t> bytes, std::size_t chunk = 997) {
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(chunk, bytes.size()))) {
    format->feed(bytes.first(std::min(chunk, bytes.size())), 0);
  }
  format->finish();
}

struct PageRig {
  void add_ephemerides() {
    for (const Ephemeris& e : read_navigation(test::shared_data(kBroadcast)).ephemerides) {
      corrections.add(e);
    }
  }
  Counts counts;
  MessageOutput output{&counts};
  SharedCorrections shared{{}, {}, &output};
  CorrectionOutput corrections{"service", &shared};
};

}  // namespace

TEST_CASE("Lines of pages become corrected states and biases", "[connect]") {
  const bool is_has = GENERATE(true, false);
  const char* source = is_has ? kHasPages : kB2bPages;
  if (!test::have_shared_data(source) || !test::have_shared_data(kBroadcast)) return;
  PageRig rig;
  rig.add_ephemerides();
  PageFormat format(is_has ? PageService::kGalileoHas : PageService::kBeidouB2b, &rig.corrections);
  feed(&format, bytes_of(test::shared_data(source)));
  CHECK(rig.counts.of[Channel::kCorrectedStates] > 500);
  // Those of PPP-B2b are BeiDou's, which has no states without B-CNAV1.
  CHECK((rig.counts.of[Channel::kBiases] > 50) == is_has);
  const FormatCounts counts = format.counts();
  CHECK(counts.frames == (is_has ? 17'145 : 14'382));
  // Biases do not count.
  CHECK(static_cast<int>(counts.messages) == rig.counts.of[Channel::kCorrectedStates]);
  CHECK(counts.damaged == 0);
  CHECK(format.data_time()->nanoseconds / kNanosecondsPerSecond % kSecondsPerWeek > 536'000);
  CHECK_THAT(format.detail(), Catch::Contains("corrections of"));
  if (!is_has) CHECK_THAT(format.detail(), Catch::Contains("B-CNAV1"));
}

// No recording has B-CNAV1 of this hour: sets with the issues that the corrections name.
TEST_CASE("With B-CNAV1 PPP-B2b gives states and biases of BeiDou", "[connect]") {
  if (!test::have_shared_data(kB2bPages)) return;
  PageRig rig;
  PageFileReader pages(test::shared_data(kB2bPages), PageService::kBeidouB2b);
  B2bDecoder decoder;
  std::set<std::pair<SatelliteId, std::uint16_t>> known;
  for (CorrectionPage page; pages.next(&page);) {
    for (const SsrMessage& message : decoder.add(page)) {
      if (message.system != System::kBeidou || message.kind != SsrKind::kOrbit) continue;
      for (const SsrSatellite& of : message.satellites) {
        if (!of.orbit || !known.insert({of.satellite, of.orbit->issue}).second) continue;
        Ephemeris e;
        e.satellite = of.satellite;
        e.message = NavigationMessage::kBeidouCnav1;
        e.toe = e.toc = message.time;
        e.issue = of.orbit->issue;
        e.sqrt_a = 5282.6;
        e.i0 = 0.96;
        rig.corrections.add(e);
      }
    }
  }
  PageFormat format(PageService::kBeidouB2b, &rig.corrections);
  feed(&format, bytes_of(test::shared_data(kB2bPages)));
  CHECK(rig.counts.of[Channel::kCorrectedStates] > 500);
  CHECK(rig.counts.of[Channel::kBiases] > 50);
  CHECK(rig.shared.services.systems_of(0) == "BeiDou");
  CHECK(rig.shared.services.counters().without_bcnav1 == 0);
}

TEST_CASE("Of two services the one listed first is used, and the other one's text says so",
          "[connect]") {
  if (!test::have_shared_data(kHasPages) || !test::have_shared_data(kB2bPages) ||
      !test::have_shared_data(kBroadcast)) {
    return;
  }
  std::vector<std::string> told;
  Counts counts;
  MessageOutput output(&counts);
  SharedCorrections shared({}, {}, &output,
                           [&told](const ServiceChange& c) { told.push_back(to_text(c)); });
  CorrectionOutput of_b2b("beidou", &shared), of_has("galileo", &shared);
  for (const Ephemeris& e : read_navigation(test::shared_data(kBroadcast)).ephemerides) {
    of_has.add(e);
  }
  PageFormat b2b(PageService::kBeidouB2b, &of_b2b), has(PageService::kGalileoHas, &of_has);
  // Six minutes of both; PPP-B2b ends after three.
  const auto feed_second = [](StreamFormat* format, std::ifstream* lines, int second) {
    std::string line;
    for (auto begin = lines->tellg(); std::getline(*lines, line); begin = lines->tellg()) {
      if (std::stoi(line.substr(5)) > second) {
        lines->seekg(begin);
        return;
      }
      line += "\n";
      format->feed({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}, 0);
    }
  };
  std::ifstream b2b_lines(test::shared_data(kB2bPages)), has_lines(test::shared_data(kHasPages));
  for (int second = 532'800; second < 532'800 + 360; ++second) {
    if (second < 532'800 + 180) feed_second(&b2b, &b2b_lines, second - 14);
    feed_second(&has, &has_lines, second);
    if (second != 532'800 + 170) continue;
    CHECK_THAT(b2b.detail(), Catch::Contains("in use for GPS"));
    CHECK_THAT(has.detail(), Catch::Contains("in use for Galileo"));
  }
  CHECK_THAT(b2b.detail(), Catch::Contains("in reserve"));
  CHECK_THAT(has.detail(), Catch::Contains("in use for GPS, Galileo"));
  for (const std::string& text : told) INFO(text);
  CHECK(
      told.back().starts_with("corrections of GPS are now those of 'galileo' (Galileo HAS): "
                              "'beidou' (PPP-B2b) has given none for 3"));
}

TEST_CASE("Without ephemerides the text says that they are missing", "[connect]") {
  if (!test::have_shared_data(kHasPages)) return;
  PageRig rig;
  PageFormat format(PageService::kGalileoHas, &rig.corrections);
  std::vector<std::uint8_t> bytes = bytes_of(test::shared_data(kHasPages));
  bytes.resize(100'000);
  feed(&format, bytes);
  CHECK(rig.counts.of[Channel::kCorrectedStates] == 0);
  CHECK_THAT(format.why_no_messages(), Catch::Contains("without their ephemeris"));
  // The remedy is that of the most frequent reason, as of SSR.
  CHECK_THAT(format.why_no_messages(), Catch::Contains(rig.corrections.why_none()));
}

TEST_CASE("Corrections without satellites that have clocks are told without empty brackets",
          "[connect]") {
  const PageRig rig;
  CHECK(rig.corrections.why_none() ==
        "none can be used: is it the stream of a service for GPS, Galileo or BeiDou?");
}

TEST_CASE("Other bytes are no pages, and lines without end take no memory", "[connect]") {
  PageRig rig;
  PageFormat format(PageService::kGalileoHas, &rig.corrections);
  const std::string text = "# remark\n\r\nno page\n2269 0 1 6 61 " + std::string(122, 'a') + "\n";
  feed(&format, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  CHECK(format.counts().frames == 1);
  CHECK(format.counts().damaged == 2);  // a line, and a checksum
  CHECK_THAT(format.why_no_messages(), Catch::Contains("1 x page with a wrong checksum"));
  feed(&format, std::vector<std::uint8_t>(100'000, 'x'));
  CHECK(format.counts().damaged == 3);
  CHECK(format.counts().frames == 1);
  CHECK(rig.output.sent() == 0);
}

TEST_CASE("A Septentrio receiver's pages give the same messages as lines, where they are used",
          "[connect]") {
  const bool is_has = GENERATE(true, false);
  const char* source = is_has ? kHasPages : kB2bPages;
  if (!test::have_shared_data(source) || !test::have_shared_data(kBroadcast)) return;
  PageRig of_lines;
  of_lines.add_ephemerides();
  PageFormat lines(is_has ? PageService::kGalileoHas : PageService::kBeidouB2b,
                   &of_lines.corrections);
  feed(&lines, bytes_of(test::shared_data(source)));
  const test::TemporaryFile place("pages.sbf", "");
  REQUIRE(
      test::write_pages_as_sbf(is_has ? "has" : "b2b", test::shared_data(source), place.path()));
  for (const bool uses_pages : {true, false}) {
    PageRig rig;
    rig.add_ephemerides();
    GpsClock clock(TimeReference::kGnss, 0.05);
    SbfStreamOptions options;
    options.uses_pages = uses_pages;
    SbfFormat format(options, 0.05, 0.0, &clock, &rig.output, &rig.corrections);
    feed(&format, bytes_of(place.path()));
    CHECK(format.counts().damaged == 0);
    CHECK(format.counts().refused == (uses_pages ? lines.counts().refused : 0));
    CHECK(format.counts().messages == (uses_pages ? lines.counts().messages : 0));
    CHECK((format.detail().find("corrections of") != std::string::npos) == uses_pages);
    if (uses_pages) {
      CHECK(rig.counts.all.size() > 500);
      CHECK(rig.counts.all == of_lines.counts.all);
    } else {
      CHECK(rig.counts.all.empty());
    }
  }
}

TEST_CASE("A Septentrio stream without the pages that it is to give says what to turn on",
          "[connect]") {
  PageRig rig;
  GpsClock clock(TimeReference::kGnss, 0.05);
  const SbfFormat format({false, true}, 0.05, 0.0, &clock, &rig.output, &rig.corrections);
  CHECK_THAT(format.detail(), Catch::Contains("turn on GALRawCNAV and BDSRawB2b"));
}

TEST_CASE("A u-blox receiver's pages are used where that is asked for", "[connect]") {
  if (!test::have_shared_data(kWalk)) return;
  int biases_without_pages = 0;  // those of CNAV and B-CNAV
  for (const bool uses_pages : {false, true}) {
    PageRig rig;
    GpsClock clock(TimeReference::kGnss, 0.05);
    UbxStreamOptions options;
    options.uses_pages = uses_pages;
    UbxFormat format(0.05, 0.0, &clock, &rig.output, &rig.corrections, options);
    feed(&format, bytes_of(test::shared_data(kWalk)));
    CHECK((rig.counts.of[Channel::kCorrectedStates] > 5) == uses_pages);
    if (!uses_pages) biases_without_pages = rig.counts.of[Channel::kBiases];
    CHECK((rig.counts.of[Channel::kBiases] > biases_without_pages + 2) == uses_pages);
    const int biases_of_pages = rig.counts.of[Channel::kBiases] - biases_without_pages;
    CHECK(format.counts().messages + static_cast<std::uint64_t>(biases_of_pages) ==
          rig.output.sent());
    CHECK(format.counts().refused <= 1);
    const bool is_told = format.detail().find("corrections of") != std::string::npos;
    CHECK(is_told == uses_pages);
  }
}

}  // namespace leonav
