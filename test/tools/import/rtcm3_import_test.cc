// RTCM 3 recordings in an import: observations, navigation, and the date that they need.
#include <filesystem>
#include <fstream>
#include <vector>

#include "drivers/binary/crc24q.h"
#include "drivers/text/parse.h"
#include "import_outcome.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"
#include "tools/import/import.h"

namespace leonav {
namespace {

using test::left_out;

constexpr const char* kManyTypes = "wire/rtcm_NTRIP-USCL00CHL0.bin";
constexpr const char* kGmsd7 = "wire/rtklib_GMSD7_20121014.rtcm3";
constexpr const char* kSsrHour = "wire/ssr_idd2023229c.rtc";

// A dataset beside a copy of a recording.
struct Recording {
  Recording(const std::string& yaml_text, const char* source, const std::string& name)
      : yaml("set.yaml", yaml_text) {
    std::filesystem::copy_file(test::shared_data(source), yaml.beside(name));
  }
  ImportReport import() const {
    return import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
  }
  std::string error() const {
    try {
      import();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }
  test::TemporaryFile yaml;
};

using Catch::Contains;

// A frame around a message of `size` zero octets behind its number.
std::string frame(unsigned number, std::size_t size) {
  std::vector<std::uint8_t> bytes(5 + size);
  bytes[0] = 0xD3;
  bytes[2] = static_cast<std::uint8_t>(2 + size);
  bytes[3] = static_cast<std::uint8_t>(number >> 4U);
  bytes[4] = static_cast<std::uint8_t>(number << 4U);
  const std::uint32_t crc = crc24q(BitReader(bytes), static_cast<int>(8 * bytes.size()));
  for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(crc >> shift));
  return {bytes.begin(), bytes.end()};
}

// Imports one epoch with these bytes as navigation.
ImportReport import_with_navigation(const std::string& bytes) {
  const test::TemporaryFile yaml("set.yaml",
                                 "date: 2024-05-06\nobservations: a.obs\nnavigation: a.rtcm3\n");
  std::ofstream(yaml.beside("a.rtcm3"), std::ios::binary) << bytes;
  std::ofstream(yaml.beside("a.obs"))
      << "     3.05           OBSERVATION DATA    M                   RINEX VERSION / TYPE\n"
         "G    1 C1C                                                  SYS / # / OBS TYPES\n"
         "                                                            END OF HEADER\n"
         "> 2024 05 06 02 00  0.0000000  0  1\nG01  20000000.000\n";
  return import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
}

}  // namespace

TEST_CASE("RTCM 3 ephemerides of systems that are not used cost a warning alone", "[import]") {
  const ImportReport report =
      import_with_navigation(frame(1020, 43) + frame(1029, 9) + frame(1044, 59) + frame(1041, 59));
  CHECK(report.epochs == 1);
  CHECK(report.ephemerides == 0);
  std::string warnings;
  for (const std::string& warning : report.warnings) warnings += warning + "\n";
  CHECK_THAT(warnings,
             Contains("a.rtcm3 holds no usable ephemeris; 1 x message 1020: GLONASS ephemeris") &&
                 Contains("QZSS") && Contains("NavIC") && Contains("no satellite has a position"));
}

TEST_CASE("RTCM 3 navigation without any ephemeris, or with a damaged one, stops the import",
          "[import]") {
  const std::string glonass = frame(1020, 43);
  std::string damaged = frame(1019, 59);
  damaged[20] ^= 1;
  for (const std::string& bytes :
       {frame(1029, 9), frame(1087, 40), glonass + frame(1019, 10), damaged + glonass}) {
    CHECK_THROWS_WITH(import_with_navigation(bytes),
                      Contains("a.rtcm3") && Contains("no usable ephemeris"));
  }
}

TEST_CASE("an RTCM 3 recording gives epochs, ephemerides and its antenna", "[import]") {
  if (!test::have_shared_data(kManyTypes)) return;
  const Recording recording("date: 2024-03-19\nobservations: a.RTCM\n", kManyTypes, "a.RTCM");
  const ImportReport report = recording.import();
  CHECK(report.epochs == 1);
  CHECK(report.ephemerides == 4);
  CHECK(report.first == GpsTime::from_week_and_tow(2306, 318'945.0));
  CHECK(left_out(report, "message 1087: GLONASS observations (system not used)") == 1);
  CHECK(left_out(report, "message 1004: GPS observations of the old form") == 1);
  CHECK(left_out(report, "message 1230: GLONASS code and phase biases") == 1);
  CHECK(left_out(report, "twice in an epoch") == 100);
}

TEST_CASE("an RTCM 3 recording needs a date, and says so", "[import]") {
  if (!test::have_shared_data(kGmsd7)) return;
  CHECK_THAT(Recording("observations: a.rtcm3\n", kGmsd7, "a.rtcm3").error(),
             Contains("a.rtcm3") && Contains("date: 2024-03-20"));
  CHECK_THAT(Recording("navigation: a.rtcm3\n", kGmsd7, "a.rtcm3").error(),
             Contains("a.rtcm3") && Contains("date: 2024-03-20"));
  // A wrong year gives no ephemerides: their own weeks contradict it.
  CHECK_THAT(Recording("date: 2013-10-14\nnavigation: a.rtcm3\n", kGmsd7, "a.rtcm3").error(),
             Contains("no usable ephemeris") && Contains("date is wrong"));
  for (const char* wrong : {"2012-13-01", "2012-02-30", "12-10-14", "2012/10/14", "[2012-10-14]"}) {
    CHECK_THAT(
        Recording("date: " + std::string(wrong) + "\nobservations: a.rtcm3\n", kGmsd7, "a.rtcm3")
            .error(),
        Contains("set.yaml:1") && Contains("'date' must be the day"));
  }
}

TEST_CASE("ephemerides of a stream of corrections serve as navigation", "[import]") {
  if (!test::have_shared_data(kGmsd7) || !test::have_shared_data(kSsrHour)) return;
  // The epochs are of another year than the ephemerides: each is refused by its own week.
  const Recording old("date: 2012-10-14\nobservations: a.rtcm3\n", kGmsd7, "a.rtcm3");
  const ImportReport report = old.import();
  CHECK(report.epochs >= 257);
  CHECK(report.ephemerides > 5);
  std::filesystem::copy_file(test::shared_data(kSsrHour), old.yaml.beside("b.rtcm"));
  const test::TemporaryFile yaml("set.yaml",
                                 "date: 2023-08-17\nobservations: " + std::string("a.obs") +
                                     "\nnavigation: " + old.yaml.beside("b.rtcm") + "\n");
  std::ofstream(yaml.beside("a.obs"))
      << "     3.05           OBSERVATION DATA    M                   RINEX VERSION / TYPE\n"
         "G    1 C1C                                                  SYS / # / OBS TYPES\n"
         "                                                            END OF HEADER\n"
         "> 2023 08 17 01 59 59.0000000  0  1\nG01  20000000.000\n"
         "> 2023 08 17 03 00  0.0000000  0  1\nG01  20000000.000\n";
  const ImportReport with =
      import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
  CHECK(with.ephemerides > 50);
  CHECK(left_out(with, "SSR message (used where the file is listed under corrections)") > 1000);
  CHECK(left_out(with, "ephemeris that repeats the one before") > 5000);
}

TEST_CASE("corrections arrive late and make states and biases", "[import]") {
  if (!test::have_shared_data(kSsrHour)) return;
  // The stream begins at 352752 s of week 2275, 02:00 of a Thursday less 18 s.
  const auto import = [](const std::string& keys) {
    const test::TemporaryFile yaml("set.yaml", "date: 2023-08-17\nobservations: a.obs\n" + keys);
    std::filesystem::copy_file(test::shared_data(kSsrHour), yaml.beside("ssr.rtcm3"));
    std::ofstream(yaml.beside("a.obs"))
        << "     3.05           OBSERVATION DATA    M                   RINEX VERSION / TYPE\n"
           "G    1 C1C                                                  SYS / # / OBS TYPES\n"
           "                                                            END OF HEADER\n"
           "> 2023 08 17 02 00  0.0000000  0  1\nG01  20000000.000\n"
           "> 2023 08 17 02 10  0.0000000  0  1\nG01  20000000.000\n";
    return import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
  };
  const ImportReport report = import("corrections: ssr.rtcm3\n");
  CHECK(report.corrected_states > 2000);
  CHECK(report.signal_biases > 5000);
  CHECK(report.ephemerides > 30);
  const ImportReport late = import("corrections: ssr.rtcm3\ncorrections_latency_s: 300\n");
  CHECK(late.corrected_states == 0);
  CHECK(left_out(late, "correction that is too old") > 1000);
  const ImportReport empty = import("corrections: []\n");
  CHECK(empty.corrected_states == 0);
  for (const char* wrong : {"corrections_latency_s: -1", "corrections_latency_s: soon",
                            "corrections_latency_s: .nan", "corrections_point: top"}) {
    CHECK_THROWS_WITH(import(std::string("corrections: ssr.rtcm3\n") + wrong + "\n"),
                      Contains("set.yaml:4"));
  }
  CHECK_THROWS_WITH(import("corrections: a.obs\n"), Contains("no usable SSR message"));
}

}  // namespace leonav
