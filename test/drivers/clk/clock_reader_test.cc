#include "drivers/clk/clock_reader.h"

#include <cmath>
#include <map>

#include "drivers/sp3/sp3_reader.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

// A header with its labels in column 61, or 66 as version 3.04 has them.
std::string header(const std::string& version, const std::string& time_system,
                   std::size_t label_column = 60) {
  std::string text = padded(version, 20) + "CLOCK DATA";
  text = padded(text, label_column) + "RINEX VERSION / TYPE\n";
  if (!time_system.empty()) {
    text += padded("   " + time_system, label_column) + "TIME SYSTEM ID\n";
  }
  return text + padded("", label_column) + "END OF HEADER\n";
}

const std::string kClockHeader = header("     3.00", "GPS");
const std::string kG01 = "AS G01  2024  1  1  0  0  0.000000  2   -0.123456789012E-03  0.5D-11\n";
const std::string kE05 = "AS E05  2024  1  1  0  0  0.000000  1    0.200000000000E-03\n";
const std::string kG01Later =
    "AS G01  2024  1  1  0  0 30.000000  2   -0.123456789000E-03  0.500000000000E-11\n";
const GpsTime kMidnight = GpsTime::from_week_and_tow(2295, 86'400.0);

struct File {
  std::vector<ClockEpoch> epochs;
  ClockCounts counts;
};

File read_path(const std::string& path) {
  File file;
  ClockReader reader(path);
  for (ClockEpoch epoch; reader.next(&epoch);) file.epochs.push_back(epoch);
  file.counts = reader.counts();
  return file;
}

File read_clock_text(const std::string& text) {
  return read_path(test::TemporaryFile("a.clk", text).path());
}

}  // namespace

TEST_CASE("RINEX clocks come epoch by epoch, without positions") {
  const File file = read_clock_text(
      kClockHeader + kG01 + "AR BRUX 2024  1  1  0  0  0.000000  2    0.1E-08  0.1E-10\n" + kE05 +
      "AS R07  2024  1  1  0  0  0.000000  1    0.1E-03\n" +
      "AS G02  2024  1  1  0  0  0.000000  6    0.300000000000E-03  0.1E-10\n"
      "    0.100000000000E-12  0.1E-13  0.1E-15  0.1E-16\n" +
      "AS G03  2024  1  1  0  0  0.000000  1    0.999999999999E+06\n" + kG01Later);
  REQUIRE(file.epochs.size() == 2);
  CHECK(file.epochs[0].time == kMidnight);
  REQUIRE(file.epochs[0].states.size() == 3);
  CHECK(to_string(file.epochs[0].states[0].satellite) == "G01");
  CHECK(to_string(file.epochs[0].states[1].satellite) == "G02");
  CHECK(file.epochs[0].states[0].clock_s == Approx(-0.123456789012e-3).epsilon(1e-15));
  CHECK(file.epochs[0].states[1].clock_s == Approx(0.3e-3).epsilon(1e-15));
  CHECK(file.epochs[0].states[2].clock_s == Approx(0.2e-3).epsilon(1e-15));
  CHECK(file.epochs[0].states[2].is_clock_only());
  CHECK(file.epochs[1].time == kMidnight.plus_seconds(30.0));
  CHECK(file.counts.states == 4);
  CHECK(file.counts.other_records == 1);
  CHECK(file.counts.other_system == 1);
  CHECK(file.counts.bad_clocks == 1);
  CHECK(file.counts.damaged_lines == 0);
}

TEST_CASE("every version's columns are read") {
  const std::string wide =
      "AS G01       2024 01 01 00 00  0.000000  2    -0.123456789012E-03  0.5E-11\n"
      "AR BRUX00BEL 2024 01 01 00 00  0.000000  1     0.123456789012E-03\n";
  CHECK(read_clock_text(header("3.04", "GPS", 65) + wide).counts.damaged_lines == 0);
  CHECK(read_clock_text(header("3.04", "GPS", 65) + wide).epochs.at(0).states.at(0).clock_s ==
        Approx(-0.123456789012e-3).epsilon(1e-15));
  for (const char* version : {"     2.00", "     3.00", "     3.01", "     3.02", "     3.03"}) {
    CHECK(read_clock_text(header(version, "") + kG01).epochs.at(0).time == kMidnight);
  }
  for (const char* version : {"     1.00", "     2.11", "     3.05", "     4.00"}) {
    CHECK_THROWS_WITH(read_clock_text(header(version, "") + kG01),
                      Catch::Contains(":1: is of version"));
  }
}

TEST_CASE("clock times of other systems become GPS time") {
  const auto offset_of = [](const std::string& system) {
    return seconds_between(read_clock_text(header("     3.02", system) + kG01).epochs.at(0).time,
                           kMidnight);
  };
  for (const char* same : {"GPS", "GAL", "QZS", "IRN", ""}) CHECK(offset_of(same) == 0.0);
  CHECK(offset_of("BDT") == 14.0);
  CHECK(offset_of("TAI") == -19.0);
  CHECK(offset_of("UTC") == 18.0);
  CHECK_THROWS_WITH(offset_of("XYZ"), Catch::Contains(":2: time system 'XYZ'"));
}

TEST_CASE("a damaged clock record costs that record and is named") {
  const std::string rows[] = {"AS G01\n",
                              "AS G01  2024 13  1  0  0  0.000000  1    0.1E-03\n",
                              "AS G01  2024  1  1  0  0  0.000000  2    0.1E-03\n",
                              "AS G01  2024  1  1  0  0  0.000000  1    0.1x-03\n",
                              "AS G01  2024  1  1  0  0  0.000000  1    nan\n",
                              "AS G01  2024  1  1  0  0  0.000000  9    0.1E-03  0.1E-11\n",
                              "AS G01  2024  1  1  0  0  0.000000 -1    0.1E-03  0.1E-11\n",
                              "AS 123  2024  1  1  0  0  0.000000  1    0.1E-03\n",
                              "AS G99  2024  1  1  0  0 99.000000  1    0.1E-03\n",
                              "\x01\x02\x03garbage\n",
                              "lower case\n"};
  for (const std::string& row : rows) {
    INFO(row);
    const File file = read_clock_text(kClockHeader + kE05 + row + kG01Later);
    CHECK(file.counts.states == 2);
    CHECK(file.counts.damaged_lines + file.counts.other_system == 1);
    if (file.counts.damaged_lines == 1) CHECK(file.counts.problems.at(0).line == 5);
  }
  // Twice, and at a time that is nonsense: what follows is still there.
  CHECK(read_clock_text(kClockHeader + kG01 + kG01).counts.damaged_lines == 1);
  const File far = read_clock_text(
      kClockHeader + kG01 + "AS G02  2098  1  1  0  0  0.000000  1  0.1E-03\n" + kE05 + kG01Later);
  CHECK(far.counts.states == 4);
  // Only the first are kept.
  std::string many = kClockHeader + kG01;
  for (int i = 0; i < 1000; ++i) many += "AS\n";
  CHECK(read_clock_text(many).counts.damaged_lines == 1000);
  CHECK(read_clock_text(many).counts.problems.size() == 20);
}

TEST_CASE("a clock file cut off anywhere gives no wrong clock") {
  const std::string text = kClockHeader + kG01 + kE05 + kG01Later;
  for (std::size_t length = kClockHeader.size() + 1; length < text.size(); ++length) {
    try {
      for (const ClockEpoch& epoch : read_clock_text(text.substr(0, length)).epochs) {
        for (const PreciseState& state : epoch.states) {
          const double clock_s = state.satellite.system == System::kGalileo ? 2e-4 : -1.23456789e-4;
          CHECK(state.clock_s == Approx(clock_s).epsilon(1e-9));
        }
      }
    } catch (const FileError&) {
    }
  }
}

TEST_CASE("a clock file without anything to use is an error that says so") {
  CHECK_THROWS_AS(ClockReader("no/such/file.clk"), FileError);
  CHECK_THROWS_WITH(read_clock_text(""), Catch::Contains("is empty"));
  CHECK_THROWS_WITH(read_clock_text("hello\n"), Catch::Contains(":1: does not begin"));
  CHECK_THROWS_WITH(read_clock_text(padded(padded("     3.04", 20) + "OBSERVATION DATA", 60) +
                                    "RINEX VERSION / TYPE\n"),
                    Catch::Contains(":1: is RINEX, but no clock file"));
  CHECK_THROWS_WITH(read_clock_text(kClockHeader.substr(0, kClockHeader.size() - 15)),
                    Catch::Contains("END OF HEADER"));
  CHECK_THROWS_WITH(read_clock_text(kClockHeader), Catch::Contains("holds no clock"));
}

TEST_CASE("the recorded clock file agrees with the orbit file's clocks at their common times") {
  const std::string name = "station/GRG0MGXFIN_2020177_6H30_30S.clk";
  if (!test::have_shared_data(name)) return;
  const File file = read_path(test::shared_data(name));
  // Counted by grep: 58,649 AS records, 16,422 of them of GLONASS.
  CHECK(file.counts.states == 23'459 + 18'768);
  CHECK(file.counts.other_system == 16'422);
  CHECK(file.counts.damaged_lines == 0);
  CHECK(file.counts.other_records == 0);
  CHECK(file.counts.bad_clocks == 0);
  CHECK(file.epochs.size() == 782);  // from 00:00:00 to 06:30:30
  std::map<std::pair<GpsTime, SatelliteId>, double> clocks;
  for (const ClockEpoch& epoch : file.epochs) {
    for (const PreciseState& state : epoch.states) {
      CHECK(state.time == epoch.time);
      clocks[{state.time, state.satellite}] = state.clock_s;
    }
  }
  int compared = 0;
  for (const Sp3Epoch& epoch :
       read_sp3(test::shared_data("station/GRG0MGXFIN_2020177_15M.sp3")).epochs) {
    for (const PreciseState& state : epoch.states) {
      const auto found = clocks.find({state.time, state.satellite});
      if (found == clocks.end() || std::isnan(state.clock_s)) continue;
      CHECK(std::abs(found->second - state.clock_s) < 1.001e-12);  // the SP3 file's last digit
      ++compared;
    }
  }
  CHECK(compared > 1300);
}

}  // namespace leonav
