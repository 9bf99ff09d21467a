// Pages of Galileo HAS and PPP-B2b in GALRawCNAV and BDSRawB2b: recorded ones, and those that
// cannot be used.
#include <optional>

#include "drivers/page_lines/page_file_reader.h"
#include "drivers/sbf/raw_page.h"
#include "drivers/sbf/sbf_file_reader.h"
#include "sbf_streams.h"
#include "support/catch.h"
#include "support/pages/pages_in_sbf.h"
#include "support/pages/recorded_pages.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using test::block_of;
using test::Bytes;
using test::decode_sbf;

using test::kB2bPages;
using test::kHasPages;

// Two bits of the last octet are behind the page.
CorrectionPage without_rest(CorrectionPage page) {
  page.bits.back() &= 0xFC;
  return page;
}

std::optional<CorrectionPage> next_page(SbfFileReader* reader) {
  for (SbfOutput output; reader->next(&output);) {
    if (const auto* page = std::get_if<CorrectionPage>(&output)) return *page;
  }
  return std::nullopt;
}

// A page of ones with a good checksum.
std::vector<std::uint8_t> page_bits() {
  BitWriter<CorrectionPage{}.bits.size()> content;
  for (int i = 0; i < CorrectionPage::kContentBits; ++i) content.put(1, 1);
  content.put(crc24q(BitReader(content.bytes()), CorrectionPage::kContentBits), 24);
  return {content.bytes().begin(), content.bytes().end()};
}

// The words of a block whose bits are these, one after the other, behind `head` of `head_bits`.
std::vector<std::uint8_t> words_of(std::uint32_t head, int head_bits, std::size_t words,
                                   bool is_damaged = false) {
  BitWriter<31 * 4> writer;
  writer.put(head, head_bits);
  const std::vector<std::uint8_t> page = page_bits();
  for (std::size_t i = 0; i < page.size(); ++i) {
    writer.put(i == 7 && is_damaged ? page[i] ^ 0x10u : page[i], 8);
  }
  BitReader reader(writer.bytes());
  Bytes bytes;
  for (std::size_t i = 0; i < words; ++i) bytes.u4(reader.take(32));
  return bytes.list;
}

struct RawBlock {
  unsigned satellite = 0, passed = 1;
  bool is_damaged = false;
  std::uint32_t milliseconds = test::kTime_ms;
  std::uint32_t named_satellite = 0;  // of B2b
};

std::vector<std::uint8_t> galileo(const RawBlock& raw) {
  Bytes b;
  b.u1(raw.satellite).u1(raw.passed).u1(0).u1(19).u1(0).u1(1);
  b.join(words_of(0, 0, 16, raw.is_damaged));
  return block_of({4024, raw.milliseconds}, b.list);
}

std::vector<std::uint8_t> beidou(const RawBlock& raw) {
  Bytes b;
  b.u1(raw.satellite).u1(raw.passed).u1(0).u1(34).u1(0).u1(1);
  b.join(words_of(raw.named_satellite << 6, 12, 31, raw.is_damaged));
  return block_of({4242, raw.milliseconds}, b.list);
}

struct PageCollector : test::SbfCollector {
  void on_page(const CorrectionPage& page) override { pages.push_back(page); }
  std::vector<CorrectionPage> pages;
};

PageCollector decode_pages(const std::vector<std::vector<std::uint8_t>>& blocks) {
  PageCollector collector;
  SbfDecoder decoder;
  for (const auto& block : blocks) decoder.feed(block, &collector);
  decoder.finish(&collector);
  collector.counters = decoder.counters();
  return collector;
}

}  // namespace

TEST_CASE("Recorded pages in blocks of a Septentrio receiver are those of the lines of text") {
  for (const bool is_has : {true, false}) {
    const char* source = is_has ? kHasPages : kB2bPages;
    if (!test::have_shared_data(source)) return;
    const test::TemporaryFile place("pages.sbf", "");
    REQUIRE(
        test::write_pages_as_sbf(is_has ? "has" : "b2b", test::shared_data(source), place.path()));
    SbfFileReader blocks(place.path());
    PageFileReader lines(test::shared_data(source),
                         is_has ? PageService::kGalileoHas : PageService::kBeidouB2b);
    std::size_t same = 0, different = 0;
    for (CorrectionPage line; lines.next(&line);) {
      const std::optional<CorrectionPage> page = next_page(&blocks);
      const bool is_same = page && without_rest(*page) == without_rest(line);
      ++(is_same ? same : different);
    }
    CHECK(same == (is_has ? 17'145 : 14'382));
    CHECK(different == 0);
    CHECK_FALSE(next_page(&blocks));
    const SbfCounters c = blocks.counters();
    CHECK(c.raw.pages == same);
    CHECK(c.raw.bad_pages + c.raw.bad_length + c.raw.wrong_satellite + c.raw.crc_failed == 0);
    // B-CNAV3 of a satellite in another orbit.
    CHECK(c.navigation.other_message == (is_has ? 0 : 143));
  }
}

TEST_CASE("A page has its satellite and the time of its block") {
  const PageCollector found = decode_pages(
      {galileo({.satellite = 71 + 6}), beidou({.satellite = 241, .named_satellite = 59})});
  REQUIRE(found.pages.size() == 2);
  CHECK(found.pages[0].service == PageService::kGalileoHas);
  CHECK(found.pages[0].satellite == SatelliteId{System::kGalileo, 7});
  CHECK(found.pages[1].service == PageService::kBeidouB2b);
  CHECK(found.pages[1].satellite == SatelliteId{System::kBeidou, 59});
  for (const CorrectionPage& page : found.pages) {
    CHECK(page.received == test::time_at(test::kTime_ms));
    CHECK(is_intact(page));
    CHECK(page.bits[0] == 0xFF);
  }
}

TEST_CASE("Blocks with pages that cannot be used are counted by their reason") {
  const std::vector<std::uint8_t> too_short(6 + 15 * 4, 1);
  const PageCollector found = decode_pages({
      galileo({.satellite = 77, .is_damaged = true}),
      galileo({.satellite = 77, .passed = 0}),
      galileo({.satellite = 5}),
      galileo({.satellite = 77, .milliseconds = 0xFFFFFFFF}),
      block_of({4024}, too_short),
      block_of({4242}, too_short),
      beidou({.satellite = 241, .is_damaged = true, .named_satellite = 59}),
      beidou({.satellite = 241, .named_satellite = 60}),
      beidou({.satellite = 160, .named_satellite = 20}),  // B-CNAV3
      beidou({.satellite = 77, .named_satellite = 59}),
  });
  CHECK(found.pages.empty());
  const RawNavigationCounters& c = found.counters.raw;
  CHECK(c.pages == 0);
  CHECK(c.bad_pages == 2);
  CHECK(c.crc_failed == 1);
  CHECK(c.bad_satellite == 2);
  CHECK(c.without_time == 1);
  CHECK(c.bad_length == 2);
  CHECK(c.wrong_satellite == 1);
  CHECK(found.counters.navigation.other_message == 1);
  CHECK(found.counters.unused.empty());
}

}  // namespace leonav
