#include "drivers/rinex/navigation_reader.h"

#include "core/base/calendar.h"
#include "drivers/rinex/rinex_text.h"
#include "drivers/text/parse.h"
#include "support/catch.h"

using namespace leonav;
using namespace leonav::test;

namespace {

const std::string kHeader3 =
    header_line("     3.05           N: GNSS NAV DATA    M", "RINEX VERSION / TYPE") +
    header_line("GPSA   4.6566e-09  1.4901e-08 -5.9605e-08 -1.1921E-07", "IONOSPHERIC CORR") +
    header_line("GPSB   8.1920D+04  9.8304d+04 -6.5536e+04 -5.2429E+05", "IONOSPHERIC CORR") +
    header_line("", "END OF HEADER");

}  // namespace

TEST_CASE("RINEX 3 navigation: GPS, and the ionosphere of the header", "[rinex]") {
  for (const char* exponent : {"e", "E", "D", "d"}) {
    const auto file = read_navigation_text(
        kHeader3 + record_3("G07 2024 05 06 08 00 00",
                            {{11, 115200.0}, {26, 597.0}, {24, 63.0}, {27, 108018.0}}, exponent));
    REQUIRE(file.ephemerides.size() == 1);
    const Ephemeris& e = file.ephemerides[0];
    CHECK(to_string(e.satellite) == "G07");
    CHECK(e.message == NavigationMessage::kGpsLnav);
    CHECK(e.toc == kMonday);
    CHECK(e.toe == kMonday);
    CHECK(e.transmission_time == kMonday.plus_seconds(-7182.0));
    CHECK(e.issue == 85);
    CHECK(e.issue_clock == 597);
    CHECK(e.health == 63);
    CHECK(e.accuracy_m == 2.0);
    CHECK(e.sqrt_a == 5153.7);
    CHECK(e.group_delay_s[0] == -1e-8);
    CHECK(file.klobuchar.valid);
    CHECK(file.klobuchar.alpha[3] == -1.1921e-7);
    CHECK(file.klobuchar.beta[1] == 9.8304e4);
    CHECK(file.counts.skipped.empty());
  }
}

TEST_CASE("RINEX 3 navigation: Galileo messages by their data source bits", "[rinex]") {
  const auto message = [](double bits) {
    const auto file = read_navigation_text(
        kHeader3 + record_3("E05 2024 05 06 08 10 00",
                            {{10, 5440.6}, {11, 115800.0}, {20, bits}, {25, 2e-9}, {26, 3e-9}}));
    REQUIRE(file.ephemerides.size() == 1);
    CHECK(file.ephemerides[0].group_delay_s == std::array<double, 2>{2e-9, 3e-9});
    CHECK(file.ephemerides[0].issue == 85);
    return file.ephemerides[0].message;
  };
  CHECK(message(517) == NavigationMessage::kGalileoInav);
  CHECK(message(513) == NavigationMessage::kGalileoInav);
  CHECK(message(516) == NavigationMessage::kGalileoInav);
  CHECK(message(258) == NavigationMessage::kGalileoFnav);
  CHECK(message(2) == NavigationMessage::kGalileoFnav);
  CHECK(message(263) == NavigationMessage::kGalileoFnav);  // both, clock for E5a
  CHECK(message(519) == NavigationMessage::kGalileoInav);  // both, clock for E5b
}

TEST_CASE("RINEX 3 navigation: BeiDou times and messages", "[rinex]") {
  const std::vector<std::pair<int, double>> values = {{3, 1},         {10, 6493.4}, {11, 115200.0},
                                                      {21, 957},      {25, 1e-9},   {26, -9e-9},
                                                      {27, 115227.6}, {28, 12}};
  const auto file = read_navigation_text(kHeader3 + record_3("C03 2024 05 06 08 00 00", values) +
                                         record_3("C38 2024 05 06 08 00 00", values));
  REQUIRE(file.ephemerides.size() == 2);
  CHECK(file.ephemerides[0].message == NavigationMessage::kBeidouD2);
  CHECK(file.ephemerides[1].message == NavigationMessage::kBeidouD1);
  const Ephemeris& e = file.ephemerides[1];
  CHECK(e.toc == kMonday.plus_seconds(14.0));
  CHECK(e.toe == kMonday.plus_seconds(14.0));
  CHECK(e.transmission_time == kMonday.plus_seconds(41.6));
  CHECK(e.issue == 1);
  CHECK(e.issue_clock == 12);
  CHECK(e.group_delay_s == std::array<double, 2>{1e-9, -9e-9});
}

TEST_CASE("RINEX 3 navigation: times over the week's end, unknown transmission", "[rinex]") {
  const GpsTime sunday = from_calendar({2024, 5, 5, 0, 0, 0.0});
  const auto sent = [](double tow) {
    return read_navigation_text(kHeader3 +
                                record_3("G07 2024 05 05 00 00 00", {{11, 0.0}, {27, tow}}))
        .ephemerides.at(0)
        .transmission_time;
  };
  CHECK(sent(-7200.0) == sunday.plus_seconds(-7200.0));
  CHECK(sent(597600.0) == sunday.plus_seconds(-7200.0));
  CHECK(sent(30.0) == sunday.plus_seconds(30.0));
  CHECK_FALSE(sent(9.999e8).is_set());
  CHECK_FALSE(sent(200000.0).is_set());
  // Clock reference on Saturday, orbit reference on Sunday.
  const auto file =
      read_navigation_text(kHeader3 + record_3("G07 2024 05 04 23 59 44", {{11, 0.0}}));
  CHECK(file.ephemerides.at(0).toe == sunday);
  CHECK(file.ephemerides.at(0).toc == sunday.plus_seconds(-16.0));
}

TEST_CASE("RINEX 3 navigation: a damaged record costs itself alone", "[rinex]") {
  const auto good = [](int number) {
    char head[32];
    std::snprintf(head, sizeof head, "G%02d 2024 05 06 08 00 00", number);
    return record_3(head, {{11, 115200.0}});
  };
  std::string bad_number = good(2), cut = good(4), bad_time = good(6);
  bad_number.replace(bad_number.find("5.153"), 1, "x");
  cut.resize(cut.size() / 2);
  bad_time.replace(9, 2, "13");
  const std::string glonass = "R01 2024 05 06 08 00 00 1.0e-04\n    1\n    2\n    3\n    4\n";
  const auto file = read_navigation_text(
      kHeader3 + good(1) + bad_number + good(3) + cut + "\n" + good(5) + bad_time + glonass +
      "S33 2024 05 06 08 00 00\n    1\n    2\n    3\n" + good(7) + "    extra\n" + good(8) +
      record_3("L01 2024 05 06 08 00 00", {}) +
      record_3("G09 2024 05 06 08 00 00", {{11, 115200.0}, {8, 0.9}}) + good(10) + "\n\n");
  std::vector<int> numbers;
  for (const Ephemeris& e : file.ephemerides) numbers.push_back(e.satellite.number);
  CHECK(numbers == std::vector<int>{1, 3, 5, 8, 10});
  CHECK(file.counts.used == 5);
  CHECK(file.counts.count_of("record with a damaged number") == 1);
  CHECK(file.counts.count_of("record with missing lines") == 1);
  CHECK(file.counts.count_of("record with a damaged time") == 1);
  CHECK(file.counts.count_of("record with too many lines") == 1);
  CHECK(file.counts.count_of("record that no satellite can have sent") == 1);
  CHECK(file.counts.count_of("GLONASS satellite (system not used)") == 1);
  CHECK(file.counts.count_of("SBAS satellite (system not used)") == 1);
  CHECK(file.counts.count_of("LEO record (no broadcast message is defined)") == 1);
  CHECK(file.counts.skipped[0].first_line == 13);  // four header lines, eight of G01
}

TEST_CASE("RINEX 2 navigation: GPS with two-digit years and numbers side by side", "[rinex]") {
  const auto file = read_navigation_text(
      header_line("     2              NAVIGATION DATA", "RINEX VERSION / TYPE") +
      header_line("    0.9313D-08  0.1490D-07 -0.5960D-07 -0.1192D-06", "ION ALPHA") +
      header_line("    0.8806D+05  0.4915D+05 -0.1311D+06 -0.3277D+06", "ION BETA") +
      header_line("", "END OF HEADER") +
      " 6 99  9  2 17 51 44.0 -.839701388031D-03 -.165982783074D-10  .000000000000D+00\n"
      "     .910000000000D+02  .934062500000D+02  .116040547840D-08  .162092304801D+00\n"
      "     .484101474285D-05  .626740418375D-02  .652112066746D-05  .515365489006D+04\n"
      "     .409904000000D+06 -.242143869400D-07  .329237003460D+00 -.596046447754D-07\n"
      "     .111541663136D+01  .326593750000D+03  .206958726335D+01 -.638312302555D-08\n"
      "     .307155651409D-09  .000000000000D+00  .102500000000D+04  .000000000000D+00\n"
      "     .000000000000D+00  .000000000000D+00  .000000000000D+00  .910000000000D+02\n"
      "     .406800000000D+06  .000000000000D+00\n");
  REQUIRE(file.ephemerides.size() == 1);
  const Ephemeris& e = file.ephemerides[0];
  CHECK(to_string(e.satellite) == "G06");
  CHECK(e.toc == from_calendar({1999, 9, 2, 17, 51, 44.0}));
  CHECK(e.toe == GpsTime::from_week_and_tow(1025, 409904.0));
  CHECK(e.transmission_time == GpsTime::from_week_and_tow(1025, 406800.0));
  CHECK(e.af0 == -.839701388031e-3);
  CHECK(e.af1 == -.165982783074e-10);
  CHECK(e.i_dot == .307155651409e-9);
  CHECK(e.issue_clock == 91);
  CHECK(file.klobuchar.valid);
  CHECK(file.klobuchar.beta[0] == 88060.0);
}

TEST_CASE("what is no RINEX navigation file is refused", "[rinex]") {
  CHECK_THROWS_AS(read_navigation_text(""), FileError);
  CHECK_THROWS_AS(read_navigation_text("x\n"), FileError);
  CHECK_THROWS_AS(read_navigation_text(kHeader3.substr(0, 100)), FileError);
  CHECK_THROWS_WITH(read_navigation_text(header_line("     5.01           NAVIGATION DATA     M",
                                                     "RINEX VERSION / TYPE")),
                    Catch::Contains("5.01") && Catch::Contains("2.00 to 4"));
  CHECK_THROWS_WITH(read_navigation_text(header_line("     3.05           OBSERVATION DATA    M",
                                                     "RINEX VERSION / TYPE")),
                    Catch::Contains("not a navigation file"));
  CHECK(read_navigation_text(kHeader3).ephemerides.empty());
}
