#include "drivers/antex/antex_reader.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "drivers/text/parse.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

std::string labelled(std::string text, const std::string& label) {
  text.resize(60, ' ');
  return text + label + "\n";
}

const std::string kAntexHeader = labelled("     1.4            M", "ANTEX VERSION / SYST") +
                                 labelled("A", "PCV TYPE / REFANT") + labelled("", "END OF HEADER");

std::string start(const std::string& type, const std::string& grid, const std::string& azimuth) {
  return labelled("", "START OF ANTENNA") + labelled(type, "TYPE / SERIAL NO") +
         labelled("     " + azimuth, "DAZI") + labelled(grid, "ZEN1 / ZEN2 / DZEN") +
         labelled("     1", "# OF FREQUENCIES");
}

std::string frequency(const std::string& name, const std::string& offset, const std::string& rows) {
  return labelled("   " + name, "START OF FREQUENCY") + labelled(offset, "NORTH / EAST / UP") +
         rows + labelled("   " + name, "END OF FREQUENCY");
}

const std::string kEndOfAntenna = labelled("", "END OF ANTENNA");
const std::string kNadirGrid = "     0.0   2.0   1.0";
const std::string kRow = "   NOAZI    1.00   -2.00    3.50\n";
const std::string kOffset = "      1.00     -2.00   1500.00";

std::string satellite(const std::string& name, const std::string& validity = "") {
  return start("BLOCK IIF           " + name + "                 G063      2011-036A", kNadirGrid,
               "0.0") +
         validity + frequency(name.substr(0, 1) + "01", kOffset, kRow) + kEndOfAntenna;
}

std::string receiver(const std::string& name, const std::string& up = "    80.00") {
  return start(name, kNadirGrid, "0.0") + frequency("G01", "      1.00     -2.00 " + up, kRow) +
         kEndOfAntenna;
}

AntexFile read_antex_text(const std::string& text, const AntexSelection& selection = {}) {
  const test::TemporaryFile file("test.atx", text);
  return read_antex(file.path(), selection);
}

}  // namespace

TEST_CASE("ANTEX values come in metres and radians", "[antex]") {
  const std::string validity =
      labelled("  2011     7    16     0     0    0.0000000", "VALID FROM") +
      labelled("  2020    12    31    23    59   59.9999999", "VALID UNTIL");
  const AntexFile file = read_antex_text(kAntexHeader + satellite("G05", validity));
  REQUIRE(file.satellites.size() == 1);
  const AntennaPattern& g05 = file.satellites[0];
  CHECK_FALSE(g05.is_receiver);
  CHECK(to_string(g05.satellite) == "G05");
  CHECK(g05.band == '1');
  CHECK(g05.valid_from == from_calendar({2011, 7, 16, 0, 0, 0.0}));
  CHECK(g05.valid_until == from_calendar({2020, 12, 31, 23, 59, 59.9999999}));
  CHECK((g05.offset_m - Eigen::Vector3d(1e-3, -2e-3, 1.5)).norm() < 1e-12);
  CHECK(variation_m(view(g05.variation), 0.0, 0.0) == Approx(1e-3));
  CHECK(variation_m(view(g05.variation), 1.0 * kDegree, 0.0) == Approx(-2e-3));
  CHECK(variation_m(view(g05.variation), 2.0 * kDegree, 0.0) == Approx(3.5e-3));
  CHECK(file.damaged == 0);
  CHECK_FALSE(file.truncated);
}

TEST_CASE("Of ANTEX satellites those valid at the time are kept", "[antex]") {
  const std::string until = labelled("  2015     1     1     0     0    0.0000000", "VALID UNTIL");
  const std::string from = labelled("  2015     1     1     0     0    1.0000000", "VALID FROM");
  const std::string text = kAntexHeader + satellite("G05", until) + satellite("G05", from) +
                           satellite("R05") + satellite("L07");
  const AntexFile all = read_antex_text(text);
  CHECK(all.satellite_antennas == 3);
  CHECK(all.other_system == 1);
  const AntexFile now = read_antex_text(text, {from_calendar({2020, 1, 1}), ""});
  REQUIRE(now.satellites.size() == 2);
  CHECK(now.satellites[0].valid_from.is_set());
  CHECK(now.not_valid == 1);
  CHECK(to_string(now.satellites[1].satellite) == "L07");
}

TEST_CASE("An ANTEX receiver is found by type and radome, else without radome", "[antex]") {
  const auto find = [](const std::string& text, const std::string& name) {
    return read_antex_text(kAntexHeader + satellite("G05") + text, {GpsTime(), name});
  };
  const std::string none = receiver("TRM59800.00     NONE", "    11.00");
  const std::string dome = receiver("TRM59800.00     SCIS", "    22.00");
  const std::string single = receiver("TRM59800.00     SCIS12345678", "    33.00");
  AntexFile file = find(none + single + dome, "TRM59800.00     SCIS");
  CHECK(file.match == ReceiverMatch::kExact);
  REQUIRE(file.receiver.size() == 1);
  CHECK(file.receiver[0].is_receiver);
  CHECK(file.receiver[0].offset_m.z() == Approx(0.022));
  CHECK(file.receiver_found == "TRM59800.00     SCIS");
  file = find(none + single, "TRM59800.00 SCIS");
  CHECK(file.match == ReceiverMatch::kExact);
  CHECK(file.receiver[0].offset_m.z() == Approx(0.033));
  file = find(dome + none, "TRM59800.00     SNOW");
  CHECK(file.match == ReceiverMatch::kWithoutRadome);
  CHECK(file.receiver[0].offset_m.z() == Approx(0.011));
  file = find(dome + none, "TRM59800.00");
  CHECK(file.match == ReceiverMatch::kExact);
  CHECK(file.receiver[0].offset_m.z() == Approx(0.011));
  file = find(dome, "TRM59800.00     SNOW");
  CHECK(file.match == ReceiverMatch::kAbsent);
  CHECK(file.receiver.empty());
  CHECK(find(dome, "").match == ReceiverMatch::kNotAsked);
}

TEST_CASE("Antenna names have twenty characters however they were spaced", "[antex]") {
  CHECK(antenna_name("ASH701945E_M    SCIS") == "ASH701945E_M    SCIS");
  CHECK(antenna_name("  ASH701945E_M SCIS ") == "ASH701945E_M    SCIS");
  CHECK(antenna_name("ASH701945E_M") == "ASH701945E_M    NONE");
  CHECK(antenna_name("TRM41249USCG    SCIT") == "TRM41249USCG    SCIT");
  CHECK(antenna_name("   ").empty());
}

TEST_CASE("ANTEX receiver values by azimuth are kept, satellites' are not", "[antex]") {
  std::string rows = "   NOAZI    1.00    2.00    3.00\n";
  for (int azimuth = 0; azimuth <= 360; azimuth += 90) {
    char row[64];
    std::snprintf(row, sizeof row, "%8.1f%8.2f%8.2f%8.2f\n", azimuth * 1.0, 0.0,
                  azimuth % 360 * 0.01, azimuth % 360 * 0.02);
    rows += row;
  }
  const std::string band = frequency("G01", kOffset, rows);
  const std::string text =
      kAntexHeader + start("TRM59800.00     NONE", kNadirGrid, "90.0") + band + kEndOfAntenna +
      start("BLOCK IIF           G05                 G063      2011-036A", kNadirGrid, "90.0") +
      band + kEndOfAntenna;
  const AntexFile file = read_antex_text(text, {GpsTime(), "TRM59800.00 NONE"});
  REQUIRE(file.receiver.size() == 1);
  const AntennaGridView grid = view(file.receiver[0].variation);
  CHECK(grid.azimuths == 5);
  CHECK(variation_m(grid, 2.0 * kDegree, 270.0 * kDegree) == Approx(5.4e-3));
  CHECK(variation_m(grid, 1.0 * kDegree, 45.0 * kDegree) == Approx(0.45e-3));
  REQUIRE(file.satellites.size() == 1);
  CHECK(file.satellites[0].variation.azimuths == 1);
  CHECK(variation_m(view(file.satellites[0].variation), 2.0 * kDegree, 1.0) == Approx(3e-3));
}

TEST_CASE("A damaged antenna costs itself alone and is named", "[antex]") {
  const auto check = [](const std::string& bad, long line, const std::string& what) {
    const AntexFile file = read_antex_text(kAntexHeader + bad + satellite("G07"));
    INFO(what);
    CHECK(file.satellites.size() == 1);
    CHECK(file.damaged == 1);
    REQUIRE(file.problems.size() == 1);
    CHECK(file.problems[0].line == line);
    CHECK_THAT(file.problems[0].what, Catch::Contains(what));
  };
  const auto without = [](std::string text, const std::string& part, const std::string& instead) {
    return text.replace(text.find(part), part.size(), instead);
  };
  const std::string good = satellite("G05");
  check(without(good, "   -2.00    3.50", "   -2.0x    3.50"), 11,
        "value is missing or unreadable");
  check(without(good, "    3.50", ""), 11, "value is missing");
  check(without(good, "    3.50", "    3.50    1.00"), 11, "more values than angles");
  check(without(good, "   2.0   1.0", "   2.0   0.0"), 7, "whole number of steps");
  check(without(good, "   2.0   1.0", "   2.0  1e-9"), 7, "whole number of steps");
  check(without(good, "   1500.00", "   15oo.00"), 10, "offset is unreadable");
  check(without(good, "   1500.00", "  99500.00"), 13, "no antenna has");
  check(without(good, kRow, ""), 11, "without NOAZI");
  check(without(good, "G01", "E01"), 9, "another system");
  check(without(good, "0.0   2.0   1.0", "0.0  20.0   0.1"), 11, "missing");
  check(good.substr(0, good.size() - kEndOfAntenna.size()), 13, "before the last one's end");
  check(labelled("", "START OF ANTENNA") + kEndOfAntenna, 5, "without TYPE");
}

TEST_CASE("A cut ANTEX file says so", "[antex]") {
  const std::string text = kAntexHeader + satellite("G05") + satellite("G07");
  const std::string first = kAntexHeader + satellite("G05");
  int usable = 0;
  for (std::size_t size = 0; size + 1 < text.size(); size += 7) {
    try {
      const AntexFile file = read_antex_text(text.substr(0, size));
      ++usable;
      CHECK(file.satellites.size() == 1);
      CHECK((file.truncated || size < first.size() + 80));
    } catch (const FileError& error) {
      CHECK(size < first.size() + 7);
    }
  }
  CHECK(usable > 10);
}

TEST_CASE("What is no ANTEX file of absolute models is an error", "[antex]") {
  CHECK_THROWS_AS(read_antex("no/such/file.atx", {}), FileError);
  CHECK_THROWS_WITH(read_antex_text(""), Catch::Contains(":1: "));
  CHECK_THROWS_WITH(read_antex_text("hello\n"), Catch::Contains("expected an ANTEX file"));
  CHECK_THROWS_WITH(read_antex_text(labelled("     2.0", "ANTEX VERSION / SYST")),
                    Catch::Contains(":1: ANTEX version"));
  CHECK_THROWS_WITH(read_antex_text(labelled("     1.4", "ANTEX VERSION / SYST") +
                                    labelled("R   AOAD/M_T        NONE", "PCV TYPE / REFANT")),
                    Catch::Contains(":2: models are relative"));
  CHECK_THROWS_WITH(read_antex_text(labelled("     1.4", "ANTEX VERSION / SYST")),
                    Catch::Contains("ends within its header"));
  CHECK_THROWS_WITH(read_antex_text(kAntexHeader + satellite("R01")),
                    Catch::Contains("1 of systems not used"));
}

namespace {

// The IGS's file by another way: every number of every line that begins with NOAZI or has the label
// of an offset, added up by satellite band, without any knowledge of the structure between.
struct TextSums {
  std::map<std::string, double> offset_mm, values_mm;  // by "G05 1"
  std::map<std::string, int> values;
};

TextSums sums_of_text(const std::string& path, const std::string& stamp) {
  TextSums sums;
  std::ifstream in(path);
  std::string line, name, band, from, until;
  while (std::getline(in, line)) {
    const std::string label = line.size() > 60 ? line.substr(60) : "";
    std::istringstream words(line);
    if (label.rfind("TYPE / SERIAL", 0) == 0) {
      name = line.substr(20, 3);
      from = "0";
      until = "9";
    } else if (label.rfind("VALID", 0) == 0) {
      int year = 0, month = 0, day = 0;
      words >> year >> month >> day;
      char text[32];
      std::snprintf(text, sizeof text, "%04d%02d%02d", year, month, day);
      (label.rfind("VALID FROM", 0) == 0 ? from : until) = text;
    } else if (label.rfind("START OF FREQUENCY", 0) == 0) {
      band = line.substr(5, 1);
    }
    const std::string key = name + " " + band;
    if (name.find_first_not_of("GECL0123456789") != std::string::npos) continue;
    if (!(from <= stamp && stamp <= until)) continue;
    double value = 0.0;
    if (label.rfind("NORTH / EAST", 0) == 0) {
      while (words >> value) sums.offset_mm[key] += value;
    } else if (line.rfind("   NOAZI", 0) == 0) {
      words >> name;
      name = key.substr(0, 3);
      while (words >> value) {
        sums.values_mm[key] += value;
        ++sums.values[key];
      }
    }
  }
  return sums;
}

}  // namespace

TEST_CASE("Every satellite of the recorded ANTEX file is read as its text has it", "[antex]") {
  const std::string name = "station/igs14_satellites_and_station.atx";
  if (!test::have_shared_data(name)) return;
  const std::string path = test::shared_data(name);
  const AntexFile file =
      read_antex(path, {from_calendar({2020, 6, 25, 12, 0, 0.0}), "ASH701945E_M    SCIS"});
  const TextSums sums = sums_of_text(path, "20200625");
  CHECK(file.damaged == 0);
  CHECK(file.problems.empty());
  CHECK_FALSE(file.truncated);
  std::size_t compared = 0;
  for (const AntennaPattern& pattern : file.satellites) {
    const std::string key = to_string(pattern.satellite) + " " + pattern.band;
    INFO(key);
    double total = 0.0;
    for (const float value : pattern.variation.values) total += static_cast<double>(value) * 1e3;
    REQUIRE(sums.offset_mm.count(key) == 1);
    CHECK(pattern.offset_m.sum() * 1e3 == Approx(sums.offset_mm.at(key)).margin(1e-6));
    CHECK(total == Approx(sums.values_mm.at(key)).margin(1e-3));
    CHECK(pattern.variation.angles == sums.values.at(key));
    ++compared;
  }
  CHECK(compared == sums.offset_mm.size());
  CHECK(compared > 200);
  CHECK(file.match == ReceiverMatch::kExact);
  REQUIRE(file.receiver.size() == 2);
  CHECK(file.receiver[0].offset_m.z() == Approx(0.08904));
  CHECK(variation_m(view(file.receiver[1].variation), 45.0 * kDegree, 0.0) == Approx(-6.23e-3));
  std::cout << "igs14: " << file.satellite_antennas << " satellites, " << compared
            << " bands valid on 2020-06-25, " << file.not_valid << " of other times, "
            << file.other_system << " of other systems\n";
}

}  // namespace leonav
