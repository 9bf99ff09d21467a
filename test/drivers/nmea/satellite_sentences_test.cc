// Satellites in use and in view: systems, numbers, counts, and what is not known.
#include "drivers/nmea/satellite_sentences.h"

#include <limits>

#include "core/base/angle.h"
#include "solution_of.h"
#include "support/catch.h"

namespace leonav {
namespace {

SatelliteView view(System system, std::uint16_t number, bool is_used) {
  return {{system, number}, 40.4 * kDegree, 83.6 * kDegree, 46.3, is_used};
}

std::vector<std::string> bodies(const std::string& lines) {
  std::vector<std::string> found;
  for (std::size_t at = 0; at < lines.size();) {
    const std::size_t end = lines.find("\r\n", at);
    REQUIRE(end != std::string::npos);
    CHECK(end + 2 - at <= 82);
    found.push_back(lines.substr(at + 1, end - at - 4));
    at = end + 2;
  }
  return found;
}

}  // namespace

TEST_CASE("Each system has sentences of its own", "[nmea]") {
  SkyView sky;
  sky.pdop = 1.5;
  sky.hdop = 0.9;
  sky.vdop = 1.2;
  for (std::uint16_t number = 1; number <= 5; ++number) {
    sky.satellites.push_back(view(System::kGps, number, number != 3));
  }
  sky.satellites.push_back(view(System::kGalileo, 36, true));
  sky.satellites.push_back(view(System::kBeidou, 60, true));
  sky.satellites.push_back(view(System::kLeo, 12, true));  // the standard has no number for it
  sky.satellites.push_back(view(System::kGps, 40, true));  // would be read as SBAS
  const auto used = bodies(gsa_sentences(test::munich(), &sky));
  REQUIRE(used.size() == 3);
  CHECK(used[0] == "GPGSA,A,3,01,02,04,05,,,,,,,,,1.50,0.90,1.20,1");
  CHECK(used[1] == "GAGSA,A,3,36,,,,,,,,,,,,1.50,0.90,1.20,3");
  CHECK(used[2] == "GBGSA,A,3,60,,,,,,,,,,,,1.50,0.90,1.20,4");
  const auto seen = bodies(gsv_sentences(&sky));
  REQUIRE(seen.size() == 4);
  CHECK(seen[0] == "GPGSV,2,1,05,01,40,084,46,02,40,084,46,03,40,084,46,04,40,084,46,0");
  CHECK(seen[1] == "GPGSV,2,2,05,05,40,084,46,0");
  CHECK(seen[2] == "GAGSV,1,1,01,36,40,084,46,0");
  CHECK(seen[3] == "GBGSV,1,1,01,60,40,084,46,0");
}

TEST_CASE("Of a system with more satellites in use each is named, twelve in a sentence", "[nmea]") {
  SkyView sky;
  sky.pdop = 1.5;
  sky.hdop = 0.9;
  sky.vdop = 1.2;
  for (std::uint16_t number = 1; number <= 26; ++number) {
    sky.satellites.push_back(view(System::kBeidou, number, number != 2));
  }
  for (std::uint16_t number = 1; number <= 12; ++number) {
    sky.satellites.push_back(view(System::kGps, number, true));
  }
  const auto used = bodies(gsa_sentences(test::munich(), &sky));
  REQUIRE(used.size() == 4);
  CHECK(used[0] == "GPGSA,A,3,01,02,03,04,05,06,07,08,09,10,11,12,1.50,0.90,1.20,1");
  CHECK(used[1] == "GBGSA,A,3,01,03,04,05,06,07,08,09,10,11,12,13,1.50,0.90,1.20,4");
  CHECK(used[2] == "GBGSA,A,3,14,15,16,17,18,19,20,21,22,23,24,25,1.50,0.90,1.20,4");
  CHECK(used[3] == "GBGSA,A,3,26,,,,,,,,,,,,1.50,0.90,1.20,4");
}

TEST_CASE("No more than the sentences have room for", "[nmea]") {
  SkyView sky;
  for (std::uint16_t number = 1; number <= 63; ++number) {
    sky.satellites.push_back(view(System::kBeidou, number, true));
  }
  const auto used = bodies(gsa_sentences(test::munich(), &sky));
  REQUIRE(used.size() == 6);
  CHECK(used[0] == "GBGSA,A,3,01,02,03,04,05,06,07,08,09,10,11,12,,,,4");
  CHECK(used[5] == "GBGSA,A,3,61,62,63,,,,,,,,,,,,,4");
  const auto seen = bodies(gsv_sentences(&sky));
  REQUIRE(seen.size() == 9);
  CHECK(seen[8].starts_with("GBGSV,9,9,36,33,"));
}

TEST_CASE("What is not known is empty", "[nmea]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SkyView sky;
  sky.satellites.push_back({{System::kGps, 7}, nan, nan, 0.0, false});
  sky.satellites.push_back({{System::kGps, 8}, -2.0 * kDegree, 359.7 * kDegree, 250.0, false});
  CHECK(bodies(gsv_sentences(&sky)).at(0) == "GPGSV,1,1,02,07,,,,08,-2,000,99,0");
  CHECK(bodies(gsa_sentences(test::munich(), &sky)).at(0) == "GPGSA,A,3,,,,,,,,,,,,,,,,1");
  CHECK(gsv_sentences(nullptr).empty());
  Solution none = test::munich();
  none.source = Source::kNone;
  CHECK(bodies(gsa_sentences(none, &sky)).at(0) == "GPGSA,A,1,,,,,,,,,,,,,,,,1");
}

}  // namespace leonav
