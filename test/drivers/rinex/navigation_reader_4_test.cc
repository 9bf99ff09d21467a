// RINEX 4 navigation files: records that hold what one of RINEX 3 holds, the other kinds, damage.
#include "core/base/calendar.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/rinex/rinex_text.h"
#include "drivers/text/parse.h"
#include "support/catch.h"

using namespace leonav;
using namespace leonav::test;

namespace {

const std::string kHeader4 =
    header_line("     4.01           NAVIGATION DATA     M", "RINEX VERSION / TYPE") +
    header_line("", "END OF HEADER");
const std::string kGps = "G07 2024 05 06 08 00 00", kGalileo = "E05 2024 05 06 08 10 00",
                  kBeidou = "C03 2024 05 06 08 00 00", kInclined = "C38 2024 05 06 08 00 00";
std::string named(const std::string& name, const std::string& record) {
  return "> EPH " + record.substr(0, 3) + " " + name + "\n" + record;
}
std::string good(const std::string& head) {
  if (head[0] == 'G') return record_3(head, {{10, 5282.6}, {11, 115200.0}});
  return record_3(head, {{10, 5282.6}, {11, 115200.0}, {26, -9e-9}});
}

// A record in the form of CNAV, of ten or eleven lines; `values` by their place, others are blank.
std::string cnav_record(const std::string& name, const std::string& head, int fields,
                        std::vector<std::pair<int, double>> values) {
  const double kepler[20] = {1e-4,   1e-12,    0,    2e-3, 12.5, 4e-9, 0.5,  -1e-6, 1e-2,  8e-6,
                             5282.6, 115200.0, 1e-8, -2.9, 2e-8, 0.96, 238., 0.7,   -8e-9, 3e-10};
  std::string text = head;
  for (int i = 0; i < fields; ++i) {
    if (i >= 3 && (i - 3) % 4 == 0) text += "\n    ";
    std::string field(19, ' ');
    char number[32];
    if (i < 20) std::snprintf(number, sizeof number, "%19.12e", kepler[i]), field = number;
    for (const auto& [place, value] : values) {
      if (place == i) std::snprintf(number, sizeof number, "%19.12e", value), field = number;
    }
    text += field;
  }
  return named(name, text + "\n");
}

double bias_of(const NavigationFile& file, const std::string& satellite, const std::string& code) {
  for (const SignalBias& b : file.delays) {
    if (to_string(b.satellite) == satellite && to_string(b.code) == code) return b.bias_m;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

TEST_CASE("RINEX 4 navigation: a record is that of RINEX 3, its message the named one", "[rinex]") {
  const auto file = read_navigation_text(
      kHeader4 + named("LNAV", good(kGps)) + named("INAV", good(kGalileo)) +
      named("FNAV", good(kGalileo)) + named("D2  ", good(kBeidou)) + named("D1", good(kInclined)));
  for (const auto& skip : file.counts.skipped) CHECK(skip.reason == "");
  CHECK(file.counts.used == 5);
  REQUIRE(file.ephemerides.size() == 5);
  const std::string header_3 =
      header_line("     3.05           N: GNSS NAV DATA    M", "RINEX VERSION / TYPE") +
      header_line("", "END OF HEADER");
  const auto old =
      read_navigation_text(header_3 + good(kGps) + good(kGalileo) + good(kBeidou) + good(kInclined))
          .ephemerides;
  REQUIRE(old.size() == 4);
  const auto same = [](Ephemeris a, const Ephemeris& b) {
    CHECK(a.satellite == b.satellite);
    CHECK(a.toe == b.toe);
    CHECK(a.toc == b.toc);
    CHECK(a.issue == b.issue);
    CHECK(a.issue_clock == b.issue_clock);
    CHECK(a.af0 == b.af0);
    CHECK(a.cis == b.cis);
    CHECK(a.i_dot == b.i_dot);
    CHECK(a.accuracy_m == b.accuracy_m);
    CHECK(a.group_delay_s == b.group_delay_s);
    return a.message;
  };
  CHECK(same(file.ephemerides[0], old[0]) == NavigationMessage::kGpsLnav);
  CHECK(same(file.ephemerides[1], old[1]) == NavigationMessage::kGalileoInav);
  CHECK(same(file.ephemerides[2], old[1]) == NavigationMessage::kGalileoFnav);
  CHECK(same(file.ephemerides[3], old[2]) == NavigationMessage::kBeidouD2);
  CHECK(same(file.ephemerides[4], old[3]) == NavigationMessage::kBeidouD1);
}

TEST_CASE("RINEX 4 navigation: B-CNAV1 gives elements for corrections, and group delays",
          "[rinex]") {
  const auto file = read_navigation_text(kHeader4 + cnav_record("CNV1", kInclined, 39,
                                                                {{20, 1e-14},
                                                                 {27, -1e-9},
                                                                 {29, 4e-9},
                                                                 {30, 2e-9},
                                                                 {32, 1},
                                                                 {34, 258},
                                                                 {35, 115218.0},
                                                                 {38, 2}}));
  CHECK(file.counts.skipped.empty());
  REQUIRE(file.ephemerides.size() == 1);
  const Ephemeris& e = file.ephemerides[0];
  CHECK(is_for_corrections_alone(e));
  CHECK(e.toe == kMonday.plus_seconds(14.0));
  CHECK(e.transmission_time == kMonday.plus_seconds(32.0));
  CHECK(e.issue == 2);
  CHECK(e.issue_clock == 258);
  CHECK(e.health == 1);
  CHECK(e.a_dot == 2e-3);
  CHECK(e.delta_n_dot == 1e-14);
  CHECK(bias_of(file, "C38", "1P") == Approx(kSpeedOfLight * 4e-9));
  CHECK(bias_of(file, "C38", "1D") == Approx(kSpeedOfLight * 3e-9));
  CHECK(bias_of(file, "C38", "5P") == Approx(kSpeedOfLight * 2e-9));
  CHECK(std::isnan(bias_of(file, "C38", "5D")));
  for (const SignalBias& b : file.delays) CHECK(b.time == e.transmission_time);
}

TEST_CASE("RINEX 4 navigation: of CNAV and B-CNAV2 the group delays are used", "[rinex]") {
  const std::vector<std::pair<int, double>> gps = {{25, -1e-8}, {27, 1e-9}, {30, 5e-9}};
  auto with = [](auto values, int place, double value) {
    values.emplace_back(place, value);
    return values;
  };
  const auto file = read_navigation_text(
      kHeader4 + cnav_record("CNAV", kGps, 35, with(gps, 31, 115212.0)) +
      cnav_record("CNV2", "G08 2024 05 06 08 00 00", 39, with(gps, 35, 115212.0)) +
      cnav_record("CNV2", kInclined, 39, {{28, 1e-9}, {29, 4e-9}, {30, 2e-9}}));
  CHECK(file.ephemerides.empty());
  CHECK(file.counts.all_skipped_by_design());
  CHECK(file.counts.count_of("CNAV record (group delays used, elements not used)") == 2);
  CHECK(file.counts.count_of("B-CNAV2 record (group delays used, elements not used)") == 1);
  for (const char* satellite : {"G07", "G08"}) {
    CHECK(bias_of(file, satellite, "1W") == Approx(kSpeedOfLight * -1e-8));
    CHECK(bias_of(file, satellite, "1C") == Approx(kSpeedOfLight * -1.1e-8));
    CHECK(bias_of(file, satellite, "5Q") == Approx(kSpeedOfLight * -1.5e-8));
    CHECK(std::isnan(bias_of(file, satellite, "5X")));  // ISC of L5I is blank
  }
  CHECK(bias_of(file, "C38", "5D") == Approx(kSpeedOfLight * 3e-9));
  CHECK(file.delays.front().time == kMonday.plus_seconds(12.0));
  CHECK(file.delays.back().time == kMonday.plus_seconds(14.0));  // not sent: toc
}

TEST_CASE("RINEX 4 navigation: other records are counted, the ionosphere of LNAV is used",
          "[rinex]") {
  const std::string four =
      "    2024 05 06 08 00 00 1.000000000000e-08 2.000000000000e-08"
      " 3.000000000000e-08\n"
      "     4.000000000000e-08 5.000000000000e+04 6.000000000000e+04"
      " 7.000000000000e+04\n"
      "     8.000000000000e+04 0.000000000000e+00\n";
  const auto file = read_navigation_text(
      kHeader4 + "> STO G07 LNAV\n    2024 05 06 08 00 00 GPUT\n     1 2 3 4\n" +
      "> EOP G07 CNAV\n    2024 05 06 08 00 00 1.0\n     1\n     2\n" + "> ION E05 IFNV\n" + four +
      "> ION G07 LNAV\n" + four + named("FDMA", "R01 2024 05 06 08 00 00 1.0e-04\n    1\n    2\n") +
      named("LNAV", good("J02 2024 05 06 08 00 00")) + named("SBAS", good(kGps)) +
      named("CNV3", good(kInclined)) + "> XYZ G07 LNAV\n" + named("LNAV", good(kGps)));
  CHECK(file.ephemerides.size() == 1);
  CHECK(file.klobuchar.valid);
  CHECK(file.klobuchar.alpha == std::array<double, 4>{1e-8, 2e-8, 3e-8, 4e-8});
  CHECK(file.klobuchar.beta == std::array<double, 4>{5e4, 6e4, 7e4, 8e4});
  CHECK(file.counts.used == 2);
  CHECK(file.counts.count_of("record of a time offset (not used)") == 1);
  CHECK(file.counts.count_of("record of the Earth's orientation (not used)") == 1);
  CHECK(file.counts.count_of("GLONASS satellite (system not used)") == 1);
  CHECK(file.counts.count_of("QZSS satellite (system not used)") == 1);
  CHECK(file.counts.count_of("record of another navigation message (not used)") == 2);
  CHECK(file.counts.count_of("record of a kind that is not known") == 1);
  CHECK(file.counts.count_of("record of an ionosphere model other than GPS LNAV's (not used)") ==
        1);
  CHECK(file.counts.skipped_total() == 8);
}

TEST_CASE("RINEX 4 navigation: a damaged record costs itself alone", "[rinex]") {
  const auto at = [](int number) {
    char head[32];
    std::snprintf(head, sizeof head, "G%02d 2024 05 06 08 00 00", number);
    return good(head);
  };
  std::string bad_number = named("LNAV", at(2)), cut = named("LNAV", at(4));
  bad_number.replace(bad_number.find("5.282"), 1, "x");
  cut.resize(cut.size() / 2);
  std::string bad_cnav = cnav_record("CNV1", kInclined, 39, {{35, 115218.0}, {38, 2}});
  bad_cnav.replace(bad_cnav.find("2.38"), 1, "x");
  const auto file = read_navigation_text(
      kHeader4 + "    junk\n" + named("LNAV", at(1)) + bad_number + named("LNAV", at(3)) + cut +
      "\n" + named("LNAV", at(5)) + at(6) + named("LNAV", at(7)) + "> EPH G08 LNAV\n" + at(9) +
      bad_cnav + cnav_record("CNV1", kInclined, 38, {{35, 115218.0}}) + "> EPH G10 LNAV\n" + ">\n" +
      named("LNAV", at(11) + "    extra\n") + named("LNAV", at(12)));
  std::vector<int> numbers;
  for (const Ephemeris& e : file.ephemerides) numbers.push_back(e.satellite.number);
  CHECK(numbers == std::vector<int>{1, 3, 5, 7, 12});
  CHECK_FALSE(file.counts.all_skipped_by_design());
  CHECK(file.counts.count_of("line outside a record") == 1);
  CHECK(file.counts.count_of("record with a damaged number") == 2);
  CHECK(file.counts.count_of("record with missing lines") == 2);
  CHECK(file.counts.count_of("record without its first line") == 1);
  CHECK(file.counts.count_of("record with the lines of another satellite") == 1);
  CHECK(file.counts.count_of("record without one of its elements") == 1);
  CHECK(file.counts.count_of("record with too many lines") == 1);
}

TEST_CASE("RINEX 4 navigation: a file cut off at any byte gives whole records alone", "[rinex]") {
  const std::string text =
      kHeader4 + named("LNAV", good(kGps)) +
      cnav_record("CNV1", kInclined, 39, {{29, 4e-9}, {35, 115218.0}, {38, 2}});
  for (std::size_t size = kHeader4.size(); size < text.size(); ++size) {
    const auto file = read_navigation_text(text.substr(0, size));
    for (const Ephemeris& e : file.ephemerides) {
      CHECK(e.i_dot == 3e-10);
      CHECK(e.toe.is_set());
    }
    for (const SignalBias& b : file.delays) CHECK(b.bias_m == Approx(kSpeedOfLight * 4e-9));
  }
}
