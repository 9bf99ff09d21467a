// Pages of Galileo HAS and PPP-B2b in an import.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "drivers/text/parse.h"
#include "import_outcome.h"
#include "support/catch.h"
#include "support/pages/pages_in_sbf.h"
#include "support/pages/recorded_pages.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"
#include "tools/import/import.h"

namespace leonav {
namespace {

using test::kB2bPages;
using test::kBroadcast;
using test::kHasPages;
using test::left_out;
constexpr const char* kWalk = "walk/gnss.ubx";

struct Imported {
  ImportReport report;
  std::string log;  // its bytes
};

// Two epochs, 04:00 and 04:20 of 2023-07-08.
void write_observations(const std::string& path) {
  std::ofstream(path)
      << "     3.05           OBSERVATION DATA    M                   RINEX VERSION / TYPE\n"
         "G    1 C1C                                                  SYS / # / OBS TYPES\n"
         "                                                            END OF HEADER\n"
         "> 2023 07 08 04 00  0.0000000  0  1\nG01  20000000.000\n"
         "> 2023 07 08 04 20  0.0000000  0  1\nG01  20000000.000\n";
}

// Imports a file of pages with two epochs that include it, 04:00 to 04:20 of 2023-07-08. A file
// whose name ends in .sbf is made of the lines.
Imported import_log(const char* source, const std::string& name) {
  const test::TemporaryFile yaml(
      "set.yaml", "observations: a.obs\nnavigation: b.nav\ncorrections: " + name + "\n");
  if (name.ends_with(".sbf")) {
    REQUIRE(test::write_pages_as_sbf(source == std::string(kHasPages) ? "has" : "b2b",
                                     test::shared_data(source), yaml.beside(name)));
  } else {
    std::filesystem::copy_file(test::shared_data(source), yaml.beside(name));
  }
  std::filesystem::copy_file(test::shared_data(kBroadcast), yaml.beside("b.nav"));
  write_observations(yaml.beside("a.obs"));
  Imported result;
  result.report = import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
  std::ifstream log(yaml.beside("out.lcmlog"), std::ios::binary);
  result.log = {std::istreambuf_iterator<char>(log), {}};
  return result;
}

ImportReport import_pages(const char* source, const std::string& name) {
  return import_log(source, name).report;
}

using Catch::Contains;

}  // namespace

TEST_CASE("pages of HAS make states of GPS and Galileo and biases", "[import]") {
  if (!test::have_shared_data(kHasPages)) return;
  const ImportReport report = import_pages(kHasPages, "pages.has");
  CHECK(report.corrected_states > 1000);
  CHECK(report.signal_biases > 1000);
  CHECK(left_out(report, "correction that is too old") == 0);
  CHECK(left_out(report, "wrong checksum") == 0);
}

TEST_CASE("pages of PPP-B2b make states of GPS, and BeiDou's wait for B-CNAV1", "[import]") {
  if (!test::have_shared_data(kB2bPages)) return;
  const ImportReport report = import_pages(kB2bPages, "pages.b2b");
  CHECK(report.corrected_states > 1000);
  CHECK(report.signal_biases == 0);  // they are BeiDou's
  CHECK(left_out(report, "correction of BeiDou whose ephemeris of B-CNAV1 is not there") > 1000);
}

TEST_CASE("pages in a Septentrio receiver's file make the log that lines of text make",
          "[import]") {
  for (const char* source : {kHasPages, kB2bPages}) {
    if (!test::have_shared_data(source)) return;
    const Imported lines = import_log(source, source == kHasPages ? "pages.has" : "pages.b2b");
    const Imported blocks = import_log(source, "pages.sbf");
    CHECK(blocks.report.corrected_states > 1000);
    CHECK(blocks.report.corrected_states == lines.report.corrected_states);
    CHECK(blocks.report.signal_biases == lines.report.signal_biases);
    CHECK(blocks.log == lines.log);
  }
}

// GPS is corrected by both services, Galileo by HAS.
TEST_CASE("of two services the one listed first corrects a system, the other one while it pauses",
          "[import]") {
  if (!test::have_shared_data(kHasPages) || !test::have_shared_data(kB2bPages)) return;
  const auto import = [](const std::string& order, bool is_cut) {
    const test::TemporaryFile yaml(
        "set.yaml", "observations: a.obs\nnavigation: b.nav\ncorrections: [" + order + "]\n");
    std::filesystem::copy_file(test::shared_data(kHasPages), yaml.beside("pages.has"));
    std::filesystem::copy_file(test::shared_data(kBroadcast), yaml.beside("b.nav"));
    std::ifstream from(test::shared_data(kB2bPages));
    std::ofstream to(yaml.beside("pages.b2b"));
    // Cut: nothing from 04:05:00 to 04:10:00 of BeiDou's time.
    for (std::string line; std::getline(from, line);) {
      const int second = std::stoi(line.substr(5));
      if (!is_cut || second < 532'800 + 300 || second >= 532'800 + 600) to << line << "\n";
    }
    to.close();
    write_observations(yaml.beside("a.obs"));
    return import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
  };
  const ImportReport has_first = import("pages.has, pages.b2b", false);
  const ImportReport b2b_first = import("pages.b2b, pages.has", false);
  const ImportReport cut = import("pages.b2b, pages.has", true);
  for (const ImportReport* report : {&has_first, &b2b_first, &cut}) {
    for (const std::string& note : report->notes) INFO(note);
    CHECK(left_out(*report, "while another one is in use") > 500);
  }
  CHECK(has_first.notes.back() == "changes from one correction service to another: 0");
  // HAS has the first states of GPS, until PPP-B2b has been there for a minute.
  CHECK(b2b_first.notes.back() == "changes from one correction service to another: 1");
  CHECK(cut.notes.back() == "changes from one correction service to another: 3");
  const auto tells = [](const ImportReport& report, const std::string& text) {
    return std::any_of(report.notes.begin(), report.notes.end(), [&](const std::string& note) {
      return note.find(text) != std::string::npos;
    });
  };
  CHECK(tells(has_first, "corrections of GPS are now those of 'pages.has' (Galileo HAS)"));
  CHECK_FALSE(tells(has_first, "those of 'pages.b2b'"));
  CHECK(tells(b2b_first, "corrections of Galileo are now those of 'pages.has' (Galileo HAS)"));
  CHECK(tells(cut,
              "corrections of GPS are now those of 'pages.has' (Galileo HAS): 'pages.b2b' "
              "(PPP-B2b) has given none"));
  CHECK(tells(cut, "'pages.b2b' (PPP-B2b), which is preferred to 'pages.has'"));
}

TEST_CASE("a receiver's own pages correct its observations", "[import]") {
  if (!test::have_shared_data(kWalk)) return;
  const auto import = [](const std::string& keys) {
    const test::TemporaryFile yaml("set.yaml", "observations: a.ubx\n" + keys);
    std::filesystem::copy_file(test::shared_data(kWalk), yaml.beside("a.ubx"));
    return import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
  };
  const ImportReport without = import("");
  CHECK(without.corrected_states == 0);
  CHECK(left_out(without,
                 "page of Galileo HAS (used where the file is listed under corrections)") == 634);
  const ImportReport with = import("corrections: a.ubx\n");
  CHECK(with.corrected_states > 50);
  CHECK(with.signal_biases > 50);
  CHECK(with.epochs == without.epochs);
}

TEST_CASE("a file without a message says what it holds", "[import]") {
  const test::TemporaryFile yaml("set.yaml", "observations: a.obs\ncorrections: pages.has\n");
  std::ofstream(yaml.beside("a.obs"));
  const auto error = [&yaml](const std::string& text) {
    std::ofstream(yaml.beside("pages.has")) << text;
    try {
      import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
    } catch (const FileError& fault) {
      return std::string(fault.what());
    }
    return std::string();
  };
  CHECK_THAT(error("nothing\n"), Contains("holds no usable message of corrections"));
  CHECK_THAT(error("2269 0 1 6 61 " + std::string(122, 'a') + "\n"),
             Contains("1 x page with a wrong checksum"));
}

}  // namespace leonav
