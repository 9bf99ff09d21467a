#include "drivers/bias_sinex/bias_sinex_reader.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <random>
#include <tuple>

#include "core/base/calendar.h"
#include "drivers/text/parse.h"
#include "support/catch.h"
#include "support/temporary_file.h"

using namespace leonav;
using namespace leonav::test;

namespace {

constexpr double kNanosecond_m = kSpeedOfLight * 1e-9;

const std::string kHeading =
    "*BIAS SVN_ PRN STATION__ OBS1 OBS2 BIAS_START____ BIAS_END______ UNIT __ESTIMATED_VALUE____ "
    "_STD_DEV___\n";

// One record, its fields in the columns of the heading.
std::string record(const char* kind, const char* prn, const char* one, const char* two,
                   const char* from, const char* until, double value_ns, const char* station = "",
                   const char* unit = "ns") {
  char text[160];
  std::snprintf(text, sizeof text,
                " %-4s %-4s %-3s %-9s %-4s %-4s %-14s %-14s %-4s %21.4f %11.4f\n", kind, "", prn,
                station, one, two, from, until, unit, value_ns, 0.01);
  return text;
}

std::string file_of(const std::string& records, const std::string& description = "") {
  return "%=BIA 1.00 TST 2024:123:00000 TST 2024:121:00000 2024:123:00000 A 00000100\n"
         "+FILE/REFERENCE\n DESCRIPTION        made for a test\n-FILE/REFERENCE\n"
         "+BIAS/DESCRIPTION\n TIME_SYSTEM                             G  \n" +
         description + "-BIAS/DESCRIPTION\n+BIAS/SOLUTION\n" + kHeading + records +
         "-BIAS/SOLUTION\n%=ENDBIA\n";
}

BiasSinexFile read_bias_text(const std::string& text) {
  const TemporaryFile file("test.BIA", text);
  return read_bias_sinex(file.path());
}

std::string refusal_of(const std::string& text) {
  try {
    read_bias_text(text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

constexpr const char* kDay1 = "2024:121:00000";
constexpr const char* kDay2 = "2024:122:00000";
constexpr const char* kDay3 = "2024:123:00000";
const GpsTime kStart = from_calendar({2024, 4, 30, 0, 0, 0.0});  // day 121 of a leap year

const SignalBias* find(const BiasSinexFile& file, const char* satellite, const char* code,
                       GpsTime time) {
  for (const SignalBias& b : file.biases) {
    if (to_string(b.satellite) == satellite && to_string(b.code) == code && b.valid_from <= time &&
        time < b.valid_until)
      return &b;
  }
  return nullptr;
}

}  // namespace

TEST_CASE("biases of single codes come with their validity", "[bias_sinex]") {
  const BiasSinexFile file = read_bias_text(
      file_of(record("OSB", "G01", "C1C", "", kDay1, kDay2, 10.2472) +
              record("OSB", "G01", "C1C", "", kDay2, kDay3, -3.5) +
              record("OSB", "E11", "C5Q", "", "0000:000:00000", "0000:000:00000", 1.0)));
  REQUIRE(file.biases.size() == 3);
  const SignalBias& first = file.biases[0];
  CHECK(first.kind == BiasKind::kCode);
  CHECK(first.bias_m == Approx(10.2472 * kNanosecond_m).epsilon(1e-15));
  CHECK(first.valid_from == kStart);
  CHECK(first.valid_until == kStart.plus_seconds(86'400.0));
  CHECK(find(file, "G01", "1C", kStart.plus_seconds(86'400.0))->bias_m < 0.0);
  CHECK_FALSE(file.biases[2].valid_from.is_set());
  CHECK(file.biases[2].valid_until > kStart.plus_seconds(1e9));
  CHECK_FALSE(file.truncated);
}

// IS-GPS-200 20.3.3.3.3.2 defines TGD as (t_L1P - t_L2P) / (1 - gamma), with gamma = (77/60)^2, and
// the delays of L1P and L2P against the clock as TGD and gamma TGD.
TEST_CASE("differences become biases against the pair of the clock", "[bias_sinex]") {
  const BiasSinexFile file =
      read_bias_text(file_of(record("DSB", "G05", "C1C", "C1W", kDay1, kDay2, 1.5) +
                             record("DSB", "G05", "C1W", "C2W", kDay1, kDay2, 4.0) +
                             record("DSB", "G05", "C2W", "C2L", kDay1, kDay2, -0.5) +
                             record("DSB", "G05", "C1C", "C5Q", kDay1, kDay2, 7.0)));
  const double gamma = 77.0 * 77.0 / (60.0 * 60.0), tgd = 4.0 / (1.0 - gamma);
  const auto ns = [&](const char* code) {
    const SignalBias* bias = find(file, "G05", code, kStart);
    return bias == nullptr ? NAN : bias->bias_m / kNanosecond_m;
  };
  CHECK(file.biases.size() == 5);
  CHECK(ns("1W") == Approx(tgd).epsilon(1e-12));
  CHECK(ns("2W") == Approx(gamma * tgd).epsilon(1e-12));
  CHECK(ns("1C") == Approx(tgd + 1.5).epsilon(1e-12));
  CHECK(ns("2L") == Approx(gamma * tgd + 0.5).epsilon(1e-12));
  CHECK(ns("5Q") == Approx(tgd + 1.5 - 7.0).epsilon(1e-12));
  CHECK(file.differences == 4);
}

TEST_CASE("the pair that the product names comes before the usual one", "[bias_sinex]") {
  const std::string records = record("DSB", "E11", "C1X", "C7X", kDay1, kDay2, 3.0) +
                              record("DSB", "E11", "C1X", "C5X", kDay1, kDay2, 2.0);
  const BiasSinexFile named =
      read_bias_text(file_of(records, " SATELLITE_CLOCK_REFERENCE_OBSERVABLES   E  C1X  C7X\n"));
  const double f1 = 154.0 * 154.0, f7 = 118.0 * 118.0;
  CHECK(find(named, "E11", "1X", kStart)->bias_m / kNanosecond_m ==
        Approx(-f7 / (f1 - f7) * 3.0).epsilon(1e-12));
  const double f5 = 115.0 * 115.0;
  CHECK(find(read_bias_text(file_of(records)), "E11", "1X", kStart)->bias_m / kNanosecond_m ==
        Approx(-f5 / (f1 - f5) * 2.0).epsilon(1e-12));
  const BiasSinexFile single =
      read_bias_text(file_of(records, " SATELLITE_CLOCK_REFERENCE_OBSERVABLES   E  C7X\n"));
  CHECK(find(single, "E11", "7X", kStart)->bias_m == 0.0);
  CHECK(find(single, "E11", "1X", kStart)->bias_m == Approx(3.0 * kNanosecond_m));
}

TEST_CASE("codes that no difference connects to the clock are told by name", "[bias_sinex]") {
  const BiasSinexFile file =
      read_bias_text(file_of(record("DSB", "C19", "C2I", "C6I", kDay1, kDay2, 4.0) +
                             record("DSB", "C19", "C1X", "C5X", kDay1, kDay2, 1.0)));
  CHECK(file.biases.size() == 2);
  CHECK(file.without_reference == 2);
  CHECK(file.unconnected.count({System::kBeidou, {'5', 'X'}}) == 1);
  CHECK(refusal_of(file_of(record("DSB", "C19", "C1X", "C5X", kDay1, kDay2, 1.0)))
            .find("no differences lead to the pair") != std::string::npos);
}

TEST_CASE("a damaged record costs itself and is told with its line", "[bias_sinex]") {
  const std::string good = record("OSB", "G01", "C1C", "", kDay1, kDay2, 1.0);
  const std::pair<std::string, const char*> bad[] = {
      {record("OSX", "G02", "C1C", "", kDay1, kDay2, 1.0), "no kind of bias"},
      {record("OSB", "G02", "C1C", "C1W", kDay1, kDay2, 1.0), "columns 26 to 34"},
      {record("OSB", "GXX", "C1C", "", kDay1, kDay2, 1.0), "no satellite"},
      {record("DSB", "G02", "C1C", "", kDay1, kDay2, 1.0), "columns 26 to 34"},
      {record("DSB", "G02", "C1C", "C1C", kDay1, kDay2, 1.0), "to itself"},
      {record("OSB", "G02", "C7Q", "", kDay1, kDay2, 1.0), "columns 26 to 34"},
      {record("OSB", "G02", "C1C", "", kDay2, kDay1, 1.0), "ends before it begins"},
      {record("OSB", "G02", "C1C", "", "2024:367:00000", kDay1, 1.0), "two times"},
      {record("OSB", "G02", "C1C", "", kDay1, "", 1.0), "two times"},
      {record("OSB", "G02", "C1C", "", kDay1, kDay2, 1.0, "", "m"), "not ns"},
      {record("OSB", "G02", "C1C", "", kDay1, kDay2, 3001.0), "up to 3000"},
      {record("OSB", "G02", "C1C", "", kDay1, kDay2, NAN), "no number"},
      {good.substr(0, 60) + "\n", "two times"}};
  for (const auto& [line, what] : bad) {
    INFO(line);
    const BiasSinexFile file = read_bias_text(file_of(good + line));
    CHECK(file.biases.size() == 1);
    CHECK(file.damaged_lines == 1);
    REQUIRE(file.problems.size() == 1);
    CHECK(file.problems[0].line == 11);
    CHECK(file.problems[0].what.find(what) != std::string::npos);
  }
}

TEST_CASE("differences that make a bias of over a thousand metres are told", "[bias_sinex]") {
  const BiasSinexFile file =
      read_bias_text(file_of(record("OSB", "G01", "C1C", "", kDay1, kDay2, 1.0) +
                             record("DSB", "E11", "C1C", "C5Q", kDay1, kDay2, 1500.0)));
  REQUIRE(file.biases.size() == 2);
  CHECK(to_string(file.biases[0].satellite) == "G01");
  CHECK(to_string(file.biases[1].code) == "1C");
  CHECK(std::abs(file.biases[1].bias_m) <= kLargestBias_m);
  REQUIRE(file.problems.size() == 1);
  CHECK(file.problems[0].line == 11);
  CHECK(file.problems[0].what.find("E11 has a bias of") == 0);
}

TEST_CASE("records of other things are counted apart", "[bias_sinex]") {
  std::string sloped = record("OSB", "G03", "C1C", "", kDay1, kDay2, 1.0);
  sloped.back() = ' ';
  sloped += "               0.0010\n";
  std::string flat = record("OSB", "G04", "C1C", "", kDay1, kDay2, 1.0);
  flat.back() = ' ';
  flat += "               0.0000\n";
  const BiasSinexFile file =
      read_bias_text(file_of(flat + sloped + record("OSB", "G01", "C1C", "", kDay1, kDay2, 1.0) +
                             record("DSB", "G01", "C1C", "C1W", kDay1, kDay2, 1.0) +
                             record("OSB", "R01", "C1C", "", kDay1, kDay2, 1.0) +
                             record("OSB", "G", "C1C", "", kDay1, kDay2, 1.0, "ABMF") +
                             record("OSB", "G01", "L1C", "", kDay1, kDay2, 1.0) +
                             record("OSB", "G01", "L1C", "", kDay1, kDay2, 1.0, "", "cyc") +
                             record("ISB", "G01", "C1C", "", kDay1, kDay2, 1.0)));
  CHECK(file.biases.size() == 2);
  CHECK(file.slopes == 1);
  CHECK(file.beside_absolute == 1);
  CHECK(file.other_system == 1);
  CHECK(file.stations == 1);
  CHECK(file.phases == 2);
  CHECK(file.other_kind == 1);
  CHECK(file.damaged_lines == 0);
}

TEST_CASE("what is no Bias-SINEX file, or has nothing to use, is refused", "[bias_sinex]") {
  CHECK(refusal_of("").find("is empty") != std::string::npos);
  CHECK(refusal_of("     3.05  OBSERVATION DATA\n").find("%=BIA 1.00") != std::string::npos);
  CHECK(refusal_of("%=BIA 2.00 TST\n").find("version '2.00'") != std::string::npos);
  CHECK(refusal_of(file_of("")).find("holds no code bias") != std::string::npos);
  CHECK(refusal_of(file_of("", " TIME_SYSTEM  X\n")).find("time system 'X'") != std::string::npos);
  const std::string all = file_of(record("OSB", "G01", "C1C", "", kDay1, kDay2, 1.0));
  CHECK(read_bias_text(all.substr(0, all.size() - 9)).truncated);
}

TEST_CASE("times of other systems become GPS time", "[bias_sinex]") {
  const std::string one = record("OSB", "G01", "C1C", "", kDay1, kDay2, 1.0);
  const auto start = [&](const char* system) {
    return read_bias_text(file_of(one, std::string(" TIME_SYSTEM  ") + system + "\n"))
        .biases[0]
        .valid_from;
  };
  CHECK(start("G") == kStart);
  CHECK(start("E") == kStart);
  CHECK(start("C") == kStart.plus_seconds(14.0));
  CHECK(start("UTC") == kStart.plus_seconds(18.0));
  CHECK(start("TAI") == kStart.plus_seconds(-19.0));
}

TEST_CASE("biases and differences of a whole file as an independent program reads them",
          "[bias_sinex]") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> value(-40.0, 40.0);
  std::string records;
  const char* days[] = {kDay1, kDay2, kDay3};
  const auto add = [&](const char* kind, const std::string& prn, const char* one, const char* two,
                       int from, int until) {
    records += record(kind, prn.c_str(), one, two, days[from], days[until], value(random));
  };
  for (int i = 1; i <= 9; ++i) {
    const std::string number = "0" + std::to_string(i);
    if (i < 4) {
      for (const char* code : {"C1C", "C1W", "C2W", "C2L", "C5Q"}) {
        add("OSB", "G" + number, code, "", 0, 1);
        add("OSB", "G" + number, code, "", 1, 2);
      }
    } else {  // trees of differences, some of which hold for a part only
      add("DSB", "G" + number, "C1C", "C1W", 0, 2);
      add("DSB", "G" + number, "C2L", "C2W", 0, i % 2 == 0 ? 1 : 2);
      add("DSB", "G" + number, "C1C", "C2W", i % 3 == 0 ? 1 : 0, 2);
      add("DSB", "G" + number, "C5X", "C1C", 0, 1);
    }
    add("DSB", "E" + number, "C1C", "C5Q", 0, 2);
    add("DSB", "E" + number, "C1C", "C7Q", 0, 1);
    add("DSB", "E" + number, "C1X", "C5X", 0, 2);
    add("DSB", "E" + number, "C8X", "C1X", 1, 2);
    add("DSB", "C" + number, "C2I", "C7I", 0, 2);
    add("DSB", "C" + number, "C6I", "C2I", 0, 2);
    add("DSB", "C" + number, "C1P", "C5P", 0, 2);
    records += record("OSB", "G", "C1C", "", kDay1, kDay3, 1.0, "ABMF") +
               record("OSB", ("R" + number).c_str(), "C1C", "", kDay1, kDay3, 1.0) +
               record("OSB", ("G" + number).c_str(), "L1C", "", kDay1, kDay3, 1.0);
  }
  const TemporaryFile file("test.BIA", file_of(records));
  const BiasSinexFile read = read_bias_sinex(file.path());

  const TemporaryFile output("oracle.txt", "");
  std::string command =
      "python3 '" LEONAV_SOURCE_DIR "/test/oracle/bias_sinex.py' '" + file.path() + "'";
  std::vector<GpsTime> instants;
  for (const double hours : {-1.0, 0.0, 12.0, 24.0, 36.0, 48.0}) {
    instants.push_back(kStart.plus_seconds(3600.0 * hours));
    command += " " + std::to_string(instants.back().nanoseconds() / kNanosecondsPerSecond);
  }
  REQUIRE(std::system((command + " >'" + output.path() + "'").c_str()) == 0);

  std::map<std::tuple<std::int64_t, std::string, std::string>, double> expected;
  std::ifstream lines(output.path());
  std::int64_t second = 0;
  std::string satellite, code;
  for (double metres = 0.0; lines >> second >> satellite >> code >> metres;)
    expected[{second, satellite, code}] = metres;
  std::size_t compared = 0;
  double worst = 0.0;
  for (const GpsTime time : instants) {
    for (const SignalBias& b : read.biases) {
      if (time < b.valid_from || time >= b.valid_until) continue;
      const auto key = std::tuple(time.nanoseconds() / kNanosecondsPerSecond,
                                  to_string(b.satellite), to_string(b.code));
      REQUIRE(expected.count(key) == 1);
      worst = std::max(worst, std::abs(expected.at(key) - b.bias_m));
      ++compared;
    }
  }
  std::printf("%zu biases as the oracle has them, worst difference %.1e m\n", compared, worst);
  CHECK(compared == expected.size());
  CHECK(compared > 300);
  CHECK(worst < 1e-12);
}
