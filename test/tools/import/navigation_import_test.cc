// Navigation files of an import: of systems that are not used, of RINEX 4, and none at all.
#include <filesystem>
#include <fstream>
#include <vector>

#include "core/base/calendar.h"
#include "drivers/lcm/decode.h"
#include "drivers/lcm/event_log.h"
#include "drivers/text/parse.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"
#include "tools/import/import.h"

namespace leonav {
namespace {

using Catch::Contains;
using test::TemporaryFile;

const std::string kVersion3 =
    "     3.05           N: GNSS NAV DATA    M                   RINEX VERSION / TYPE\n";
const std::string kVersion4 =
    "     4.01           NAVIGATION DATA     M                   RINEX VERSION / TYPE\n";
const std::string kEnd = std::string(60, ' ') + "END OF HEADER\n";
const std::string kGps =
    "G07 2024 05 06 08 00 00 1.000000000000e-04 1.000000000000e-12 0.000000000000e+00\n"
    "     8.500000000000e+01 1.250000000000e+01 4.000000000000e-09 5.000000000000e-01\n"
    "    -1.000000000000e-06 1.000000000000e-02 8.000000000000e-06 5.153700000000e+03\n"
    "     1.152000000000e+05 1.000000000000e-08-2.900000000000e+00 2.000000000000e-08\n"
    "     9.600000000000e-01 2.380000000000e+02 7.000000000000e-01-8.000000000000e-09\n"
    "     3.000000000000e-10 1.000000000000e+00 2.313000000000e+03 0.000000000000e+00\n"
    "     2.000000000000e+00 0.000000000000e+00-1.000000000000e-08 8.500000000000e+01\n"
    "     1.116000000000e+05 4.000000000000e+00\n";
const std::string kForeign =
    "R01 2024 05 06 08 00 00 1.0e-04\n    1\n    2\n    3\nI02 2024 05 06 08 00 00 1.0e-04\n    1\n"
    "J03 2024 05 06 08 00 00 1.0e-04\n    1\n";

// The group delays of CNAV, sent at this second of the week.
std::string cnav(const std::string& tgd, const std::string& sent) {
  std::string lines = "> EPH G07 CNAV\n" + kGps.substr(0, kGps.find("     3.0000000"));
  return lines +
         "     3.000000000000e-10 0.000000000000e+00 1.000000000000e+00 0.000000000000e+00\n" +
         "     0.000000000000e+00 0.000000000000e+00 " + tgd + " 0.000000000000e+00\n" +
         std::string(80, ' ') + "\n     " + sent + "\n";
}

// Imports an observation of each second, 07:08:01 to 07:08:03 of 2024-05-06, tow 112081 to 112083.
ImportReport import_with(const TemporaryFile& yaml) {
  std::ofstream(yaml.beside("a.obs"))
      << "     3.05           OBSERVATION DATA    M                   RINEX VERSION / TYPE\n"
         "G    1 C1C                                                  SYS / # / OBS TYPES\n"
      << kEnd
      << "> 2024 05 06 07 08  1.0000000  0  1\nG01  20000000.000\n"
         "> 2024 05 06 07 08  2.0000000  0  1\nG01  20000000.000\n"
         "> 2024 05 06 07 08  3.0000000  0  1\nG01  20000000.000\n";
  return import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
}

std::string all_warnings(const ImportReport& report) {
  std::string text;
  for (const std::string& warning : report.warnings) text += warning + "\n";
  return text;
}

}  // namespace

TEST_CASE("a navigation file of systems that are not used costs a warning alone", "[import]") {
  const TemporaryFile yaml("set.yaml", "observations: a.obs\nnavigation: [other.nav, gps.nav]\n");
  std::ofstream(yaml.beside("other.nav")) << kVersion3 << kEnd << kForeign;
  std::ofstream(yaml.beside("gps.nav")) << kVersion3 << kEnd << kGps;
  const ImportReport report = import_with(yaml);
  CHECK(report.ephemerides == 1);
  CHECK(report.epochs == 3);
  const std::string warnings = all_warnings(report);
  CHECK_THAT(warnings, Contains("other.nav holds no usable ephemeris (3 records left out)"));
  CHECK_THAT(warnings, !Contains("no satellite has a position"));
  CHECK_THAT(to_string(report), Contains("GLONASS satellite (system not used)"));
  CHECK_THAT(to_string(report), Contains("NavIC satellite (system not used)"));
  CHECK_THAT(to_string(report), Contains("QZSS satellite (system not used)"));

  const TemporaryFile alone("set.yaml", "observations: a.obs\nnavigation: other.nav\n");
  std::ofstream(alone.beside("other.nav")) << kVersion3 << kEnd << kForeign;
  CHECK_THAT(all_warnings(import_with(alone)), Contains("no satellite has a position"));
}

TEST_CASE("a RINEX 2 navigation file of QZSS costs a warning alone", "[import]") {
  const TemporaryFile yaml("set.yaml", "observations: a.obs\nnavigation: [q.nav, gps.nav]\n");
  std::ofstream(yaml.beside("q.nav"))
      << "     2.12           J: QZSS NAV DATA                        RINEX VERSION / TYPE\n"
      << kEnd << " 1 24  5  6  8  0  0.0 1.0D-04 1.0D-12 0.0D+00\n    1\n    2\n";
  std::ofstream(yaml.beside("gps.nav")) << kVersion3 << kEnd << kGps;
  const ImportReport report = import_with(yaml);
  CHECK(report.ephemerides == 1);
  CHECK_THAT(all_warnings(report),
             Contains("q.nav holds no usable ephemeris (1 records left out)"));
  CHECK_THAT(to_string(report), Contains("QZSS satellite (system not used)"));
}

TEST_CASE("a navigation file of damaged records stops the import", "[import]") {
  const TemporaryFile yaml("set.yaml", "observations: a.obs\nnavigation: gps.nav\n");
  std::ofstream(yaml.beside("gps.nav")) << kVersion3 << kEnd << kForeign << kGps.substr(0, 200);
  CHECK_THROWS_WITH(import_with(yaml), Contains("gps.nav") && Contains("no usable ephemeris"));
}

TEST_CASE("a u-blox recording with ephemerides needs no navigation", "[import]") {
  if (!test::have_shared_data("walk/gnss.ubx")) return;
  const TemporaryFile yaml("set.yaml", "observations: gnss.ubx\n");
  std::filesystem::copy_file(test::shared_data("walk/gnss.ubx"), yaml.beside("gnss.ubx"));
  const ImportReport report =
      import_dataset(load_dataset(yaml.path()), {}, yaml.beside("out.lcmlog"), nullptr);
  CHECK(report.ephemerides > 0);
  CHECK_THAT(all_warnings(report), !Contains("ephemerides"));
}

TEST_CASE("group delays of a RINEX 4 file arrive when they were sent, the newest at the start",
          "[import]") {
  const TemporaryFile yaml("set.yaml", "observations: a.obs\nnavigation: brd4.nav\n");
  std::ofstream(yaml.beside("brd4.nav")) << kVersion4 << kEnd << "> EPH G07 LNAV\n"
                                         << kGps << cnav("1.000000000000e-09", "1.110000000000e+05")
                                         << cnav("2.000000000000e-09", "1.120000000000e+05")
                                         << cnav("3.000000000000e-09", "1.120820000000e+05")
                                         << cnav("4.000000000000e-09", "1.130000000000e+05");
  const ImportReport report = import_with(yaml);
  CHECK(report.ephemerides == 1);
  EventLogReader reader(yaml.beside("out.lcmlog"));
  Decoder decoder;
  std::vector<std::pair<double, double>> delays;  // time of week, delay of L1 P(Y) in ns
  for (LogEvent event; reader.next(&event);) {
    SignalBiases biases;
    if (event.channel != "LEONAV_BIASES") continue;
    REQUIRE(decoder.decode(ByteSpan(event.data), &biases).fault == InputFault::kNone);
    for (const SignalBias& bias : biases) {
      if (to_string(bias.code) != "1W") continue;
      CHECK(bias.kind == BiasKind::kBroadcastCode);
      delays.emplace_back(bias.time.tow_s(), 1e9 * bias.bias_m / kSpeedOfLight);
    }
  }
  REQUIRE(delays.size() == 2);
  CHECK(delays[0].first == Approx(112081.05));  // the first epoch's arrival
  CHECK(delays[0].second == Approx(2.0));
  CHECK(delays[1].first == Approx(112082.0));
  CHECK(delays[1].second == Approx(3.0));
}

}  // namespace leonav
