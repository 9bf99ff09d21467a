#include "drivers/sp3/sp3_reader.h"

#include <cmath>
#include <set>

#include "core/base/calendar.h"
#include "drivers/text/parse.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using test::TemporaryFile;

std::string header(const std::string& time_system) {
  return "#dP2024  1  1  0  0  0.00000000       2 ORBIT IGS20 HLM  IGS\n"
         "## 2295  86400.00000000   900.00000000 60310 0.0000000000000\n"
         "+    3   G01L05C60  0  0  0  0  0  0  0  0  0  0  0  0  0  0\n"
         "%c M  cc " +
         time_system + " ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n";
}

const std::string kEpoch1 = "*  2024  1  1  0  0  0.00000000\n";
const std::string kEpoch2 = "*  2024  1  1  0 15  0.00000000\n";
const std::string kPositionG01 = "PG01  13040.123456 -20000.654321   9000.000001    123.456789\n";
const std::string kPositionL05 = "PL05   6800.000000   -100.000000     50.500000 999999.999999\n";
const std::string kVelocity = "VG01  12345.000000  12345.000000  12345.000000    123.456789\n";

Sp3File read_sp3_text(const std::string& text) {
  return read_sp3(TemporaryFile("a.sp3", text).path());
}

}  // namespace

TEST_CASE("SP3 positions come in metres and clocks in seconds") {
  const Sp3File file =
      read_sp3_text(header("GPS") + kEpoch1 + kPositionG01 + kVelocity + "EP  55  55  55\n" +
                    kPositionL05 + "PR01   6800.000000   -100.000000     50.500000 1.0\n" +
                    "PC60      0.000000      0.000000      0.000000      1.000000\n" + kEpoch2 +
                    kPositionG01 + "EOF\n");
  CHECK(file.version == 'd');
  CHECK(file.frame == "IGS20");
  CHECK(file.satellites_listed == 3);
  CHECK_FALSE(file.truncated);
  REQUIRE(file.epochs.size() == 2);
  CHECK(file.epochs[0].time == GpsTime::from_week_and_tow(2295, 86400.0));
  REQUIRE(file.epochs[0].states.size() == 2);
  const PreciseState& g01 = file.epochs[0].states[0];
  CHECK(to_string(g01.satellite) == "G01");
  CHECK(g01.p_e.x() == Approx(13040123.456).epsilon(1e-15));
  CHECK(g01.p_e.y() == Approx(-20000654.321).epsilon(1e-15));
  CHECK(g01.clock_s == Approx(123.456789e-6).epsilon(1e-15));
  CHECK(to_string(file.epochs[0].states[1].satellite) == "L05");
  CHECK(std::isnan(file.epochs[0].states[1].clock_s));
  CHECK(file.bad_clocks == 1);
  CHECK(file.bad_positions == 1);
  CHECK(file.other_system == 1);
  CHECK(file.damaged_lines == 0);
}

TEST_CASE("SP3 flags of clocks and orbits changed or predicted are read") {
  const std::string row = "PG01  13040.123456 -20000.654321   9000.000001    123.456789 ";
  const auto state_of = [&](const std::string& flags) {
    return read_sp3_text(header("GPS") + kEpoch1 + row + flags + "\nEOF\n")
        .epochs.at(0)
        .states.at(0);
  };
  // Columns 61-73 are accuracies, 75, 76, 79 and 80 the flags.
  const PreciseState plain = state_of(" 5  5  5 100"), event = state_of(" 5  5  5 100 E"),
                     all = state_of("             EP  MP"),
                     predicted = state_of(" 5  5  5 100  P   P");
  CHECK_FALSE(
      (plain.clock_event || plain.maneuver || plain.clock_predicted || plain.orbit_predicted));
  CHECK(event.clock_event);
  CHECK_FALSE((event.maneuver || event.clock_predicted || event.orbit_predicted));
  CHECK((all.clock_event && all.maneuver && all.clock_predicted && all.orbit_predicted));
  CHECK((predicted.clock_predicted && predicted.orbit_predicted));
  CHECK_FALSE((predicted.clock_event || predicted.maneuver));
  const Sp3File counted =
      read_sp3_text(header("GPS") + kEpoch1 + row + "             EP  MP\nEOF\n");
  CHECK(counted.clock_events == 1);
  CHECK(counted.maneuvers == 1);
  CHECK(counted.predicted == 1);
}

TEST_CASE("SP3 times of other systems become GPS time") {
  const GpsTime midnight = GpsTime::from_week_and_tow(2295, 86400.0);
  const auto offset_of = [&](const std::string& system) {
    const Sp3File file = read_sp3_text(header(system) + kEpoch1 + kPositionG01 + "EOF\n");
    return seconds_between(file.epochs.at(0).time, midnight);
  };
  CHECK(offset_of("GPS") == 0.0);
  CHECK(offset_of("GAL") == 0.0);
  CHECK(offset_of("QZS") == 0.0);
  CHECK(offset_of("ccc") == 0.0);
  CHECK(offset_of("BDT") == 14.0);
  CHECK(offset_of("TAI") == -19.0);
  CHECK(offset_of("UTC") == 18.0);
  CHECK_THROWS_WITH(offset_of("XYZ"), Catch::Contains(":4: time system 'XYZ'"));
}

TEST_CASE("A damaged SP3 line costs that line and is named") {
  const Sp3File file =
      read_sp3_text(header("GPS") + kEpoch1 + "PG01  13040.12#456 -20000.654321\n" + kPositionL05 +
                    "*  2024 13  1  0 15  0.00000000\n" + kPositionG01 + kEpoch2 + kPositionG01);
  CHECK(file.truncated);
  CHECK(file.damaged_lines == 2);
  REQUIRE(file.problems.size() == 2);
  CHECK(file.problems[0].line == 6);
  CHECK(file.problems[1].line == 8);
  CHECK(file.states == 2);
}

TEST_CASE("An SP3 file without anything to use is an error") {
  CHECK_THROWS_AS(read_sp3("no/such/file.sp3"), FileError);
  CHECK_THROWS_AS(read_sp3_text(""), FileError);
  CHECK_THROWS_WITH(read_sp3_text("#aP2024\n"), Catch::Contains(":1: "));
  CHECK_THROWS_WITH(read_sp3_text(header("GPS") + kEpoch1 + "EOF\n"),
                    Catch::Contains("no position"));
}

TEST_CASE("Every satellite of the recorded SP3 files is read") {
  const std::string drive = "drive/COD0MGXFIN_20211180000_05M_ORB.SP3";
  if (test::have_shared_data(drive)) {
    const Sp3File file = read_sp3(test::shared_data(drive));
    std::set<SatelliteId> satellites;
    for (const Sp3Epoch& epoch : file.epochs) {
      for (const PreciseState& state : epoch.states) satellites.insert(state.satellite);
    }
    CHECK(file.satellites_listed == 116);
    CHECK(satellites.size() == 92);  // and 24 of GLONASS
    CHECK(file.epochs.size() == 73);
    CHECK(file.states == 92 * 73);
    CHECK(file.other_system == 24 * 73);
    CHECK(file.bad_clocks == 93);
    CHECK(file.damaged_lines == 0);
  }
  const std::string station = "station/GRG0MGXFIN_2020177_15M.sp3";
  if (test::have_shared_data(station)) {
    const Sp3File file = read_sp3(test::shared_data(station));
    CHECK(file.version == 'c');
    CHECK(file.epochs.size() == 96);
    CHECK(file.states == 54 * 96);
    CHECK(file.other_system == 21 * 96);
    // First line of the first epoch, read by eye.
    CHECK(file.epochs[0].time == GpsTime::from_week_and_tow(2111, 345600.0));
    for (const PreciseState& state : file.epochs[0].states) {
      if (to_string(state.satellite) != "E01") continue;
      CHECK(state.p_e.z() == Approx(23345128.269).epsilon(1e-15));
      CHECK(state.clock_s == Approx(-884.707516e-6).epsilon(1e-15));
    }
  }
}

}  // namespace leonav
