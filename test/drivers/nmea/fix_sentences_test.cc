// Whole sentences, worked out by hand; checksums by an exclusive or in Python.
#include "drivers/nmea/fix_sentences.h"

#include "solution_of.h"
#include "support/catch.h"

namespace leonav {
namespace {

// The body, without '$', checksum and line end.
std::string body(const std::string& line) {
  REQUIRE(line.size() > 6);
  CHECK(line.size() <= 82);
  CHECK(line.ends_with("\r\n"));
  return line.substr(1, line.size() - 6);
}

SkyView sky() {
  SkyView view;
  view.used = 8;
  view.hdop = 0.9;
  return view;
}

}  // namespace

TEST_CASE("A solution with GNSS", "[nmea]") {
  const Solution solution = test::munich();
  const SkyView view = sky();
  const FixOptions options{46.9, 50.0};
  CHECK(body(gga_sentence(solution, &view, options)) ==
        "GNGGA,123519.00,4807.038000,N,01131.000000,E,1,08,0.90,498.500,M,46.9,M,,");
  CHECK(body(rmc_sentence(solution, options)) ==
        "GNRMC,123519.00,A,4807.038000,N,01131.000000,E,10.000,90.00,250620,,,A,V");
  CHECK(body(vtg_sentence(solution, options)) == "GNVTG,90.00,T,,M,10.000,N,18.520,K,A");
  CHECK(body(gst_sentence(solution)) == "GNGST,123519.00,,,,,0.500,0.250,1.000");
  CHECK(body(hdt_sentence(solution)) == "GNHDT,270.00,T");
  CHECK(body(zda_sentence(solution)) == "GNZDA,123519.00,25,06,2020,00,00");
}

TEST_CASE("Without a position the fields are empty, and the time remains", "[nmea]") {
  Solution solution = test::munich();
  solution.source = Source::kNone;
  const SkyView view = sky();
  CHECK(body(gga_sentence(solution, &view, {})) == "GNGGA,123519.00,,,,,0,00,,,,,,,");
  CHECK(body(rmc_sentence(solution, {})) == "GNRMC,123519.00,V,,,,,,,250620,,,N,V");
  CHECK(body(vtg_sentence(solution, {})) == "GNVTG,,T,,M,,N,,K,N");
  CHECK(body(gst_sentence(solution)) == "GNGST,123519.00,,,,,,,");
  CHECK(body(hdt_sentence(solution)) == "GNHDT,,T");
}

TEST_CASE("INS alone is dead reckoning, with a warning where it has become inaccurate", "[nmea]") {
  Solution solution = test::munich();
  solution.source = Source::kInsOnly;
  const SkyView view = sky();
  CHECK(body(gga_sentence(solution, &view, {})) ==
        "GNGGA,123519.00,4807.038000,N,01131.000000,E,6,00,,545.400,M,0.0,M,,");
  CHECK(body(rmc_sentence(solution, {0.0, 50.0})).substr(0, 17) == "GNRMC,123519.00,A");
  CHECK(body(rmc_sentence(solution, {})).ends_with(",E,V"));
  solution.sigma_p_n = {40.0, 40.0, 1.0};
  CHECK(body(rmc_sentence(solution, {0.0, 50.0})).substr(0, 17) == "GNRMC,123519.00,V");
  CHECK(body(vtg_sentence(solution, {})).ends_with(",E"));
}

TEST_CASE("Without attitude there is no heading", "[nmea]") {
  Solution solution = test::munich();
  solution.has_attitude = false;
  CHECK(body(hdt_sentence(solution)) == "GNHDT,,T");
}

TEST_CASE("At rest there is no course", "[nmea]") {
  Solution solution = test::munich();
  solution.v_n = {0.03, 0.0, 0.0};
  CHECK(body(vtg_sentence(solution, {})) == "GNVTG,,T,,M,0.058,N,0.108,K,A");
  solution.v_n = {-1.0, 0.0, 0.0};
  CHECK(body(vtg_sentence(solution, {})).starts_with("GNVTG,180.00,T"));
  solution.sigma_v_n = {0.6, 0.6, 0.6};
  CHECK(body(vtg_sentence(solution, {})).starts_with("GNVTG,,T"));
}

TEST_CASE("Heights may be negative, and long ones lose decimals, not characters", "[nmea]") {
  Solution solution = test::munich();
  solution.height = -430.5;
  const FixOptions options{-106.9, 50.0};
  const SkyView view = sky();
  CHECK(body(gga_sentence(solution, &view, options)).ends_with(",-323.600,M,-106.9,M,,"));
  solution.time = solution.time.plus_nanoseconds(5'000'000);  // takes a decimal's place
  CHECK(body(gga_sentence(solution, &view, options)).ends_with(",-323.60,M,-106.9,M,,"));
  for (const double height : {-9'999.9996, 999.9996, 12'345.67, -999.9996, -99.9996, 123'456.7}) {
    solution.height = height;
    SkyView poor = view;
    poor.hdop = 250.0;
    CHECK(gga_sentence(solution, &poor, options).size() <= 82);
  }
  SkyView nearly = view;
  nearly.hdop = 9.996;
  CHECK(body(gga_sentence(solution, &nearly, options)).find(",08,10.0,") != std::string::npos);
}

}  // namespace leonav
