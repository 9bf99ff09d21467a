// Elements of LEO satellites as a table: what is written is read as the same bits, and a bad row
// costs itself.
#include "drivers/csv/leo_elements_csv.h"

#include <fstream>
#include <string>
#include <vector>

#include "support/catch.h"
#include "support/temporary_file.h"

using namespace leonav;
using Catch::Contains;

namespace {

Ephemeris elements(std::uint16_t number) {
  Ephemeris e;
  e.satellite = {System::kLeo, number};
  e.toe = GpsTime::from_week_and_tow(2300, 100.0);
  e.toc = e.toe.plus_seconds(10.0);
  e.transmission_time = e.toe.plus_seconds(-300.0);  // in the week before
  e.issue = 12, e.issue_clock = 13, e.health = 1;
  e.accuracy_m = 1.0;
  e.sqrt_a = 2736.123456789, e.eccentricity = 1.0 / 3.0e3, e.m0 = -2.1, e.delta_n = 1.1e-7;
  e.omega0 = 0.3, e.omega_dot = -1.0 / 7.0e6, e.i0 = 0.9, e.i_dot = 2e-9, e.omega = 1.7;
  e.cuc = 1e-5, e.cus = 2e-5, e.crc = 333.3, e.crs = -44.4, e.cic = 5e-6, e.cis = -6e-6;
  e.a_dot = 0.01, e.delta_n_dot = 3e-12;
  e.af0 = 1e-4, e.af1 = -1e-11, e.af2 = 1e-18;
  return e;
}

const std::string kMinimal(kLeoElementsColumns);
// toe, then transmission, sqrt_a and the other elements.
std::string row(const std::string& satellite, const std::string& sqrt_a = "2736") {
  std::string text = satellite;
  text.append(",2300,600,300,").append(sqrt_a);
  return text.append(",0.001,0,0,0.3,0,0.9,0,1.7,0,0,0,0,0,0,1e-4,0\n");
}

// A table of the columns that must be there.
std::string table(const std::vector<std::string>& rows) {
  std::string text = kMinimal;
  text.append("\n");
  for (const std::string& one : rows) text.append(one);
  return text;
}

LeoElementsCsv read(const std::string& text) {
  const test::TemporaryFile file("leo.csv", text);
  return read_leo_elements_csv(file.path());
}

}  // namespace

TEST_CASE("elements are read as the bits that were written", "[csv]") {
  const test::TemporaryFile file("leo.csv", "");
  Ephemeris gps;
  gps.satellite = {System::kGps, 1};
  const std::vector<Ephemeris> written = {elements(1), gps, elements(399)};
  write_leo_elements_csv(file.path(), written);
  const LeoElementsCsv read = read_leo_elements_csv(file.path());
  REQUIRE(read.ephemerides.size() == 2);
  for (const Ephemeris& e : read.ephemerides) {
    const Ephemeris wanted = elements(e.satellite.number);
    CHECK(e.toe == wanted.toe);
    CHECK(e.toc == wanted.toc);
    CHECK(e.transmission_time == wanted.transmission_time);
    CHECK((e.issue == 12 && e.issue_clock == 13 && e.health == 1));
    for (const auto member :
         {&Ephemeris::sqrt_a,      &Ephemeris::eccentricity, &Ephemeris::m0,  &Ephemeris::delta_n,
          &Ephemeris::omega0,      &Ephemeris::omega_dot,    &Ephemeris::i0,  &Ephemeris::i_dot,
          &Ephemeris::omega,       &Ephemeris::cuc,          &Ephemeris::cus, &Ephemeris::crc,
          &Ephemeris::crs,         &Ephemeris::cic,          &Ephemeris::cis, &Ephemeris::a_dot,
          &Ephemeris::delta_n_dot, &Ephemeris::af0,          &Ephemeris::af1, &Ephemeris::af2,
          &Ephemeris::accuracy_m}) {
      CHECK(e.*member == wanted.*member);
    }
  }
  CHECK(read.ephemerides[1].satellite == SatelliteId{System::kLeo, 399});
}

TEST_CASE("columns that are left out have their defaults", "[csv]") {
  const LeoElementsCsv file = read(table({row("M05")}));
  REQUIRE(file.ephemerides.size() == 1);
  const Ephemeris& e = file.ephemerides[0];
  CHECK(e.satellite == SatelliteId{System::kLeo, 105});
  CHECK(e.toc == e.toe);
  CHECK(e.health == 0);
  CHECK(e.accuracy_m < 0.0);
  CHECK(e.a_dot == 0.0);
}

TEST_CASE("a bad row of elements costs itself and is named", "[csv]") {
  const LeoElementsCsv file =
      read(table({row("L01"), row("G01"), row("L02", "2.736e6"), row("L03", ""), row("L04", "x"),
                  row("L05"), "L06,2300\n"}));
  CHECK(file.ephemerides.size() == 2);
  CHECK(file.report.skipped == 5);
  REQUIRE(file.report.problems.size() == 5);
  CHECK_THAT(file.report.problems[0], Contains(":3: ") && Contains("L01 to O99"));
  CHECK_THAT(file.report.problems[1], Contains(":4: ") && Contains("units"));
  CHECK_THAT(file.report.problems[2], Contains(":5: ") && Contains("sqrt_a_sqrt_m"));
  CHECK_THAT(file.report.problems[3], Contains(":6: ") && Contains("finite"));
}

TEST_CASE("a table without one of the elements is refused, with the column", "[csv]") {
  std::string header = kMinimal;
  header.erase(header.find(",cic_rad"), 8);
  CHECK_THROWS_WITH(read(header), Contains(":1") && Contains("'cic_rad'"));
  CHECK_THROWS(read(table({row("G01")})));
}
