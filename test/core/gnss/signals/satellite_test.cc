#include "core/gnss/signals/satellite.h"

#include "support/catch.h"

namespace leonav {

TEST_CASE("Every satellite's name reads back as the same satellite", "[satellite]") {
  const std::array<int, kSystemCount> highest = {63, 50, 63, 399};
  for (const System system : kSystems) {
    for (int number = 1; number <= highest[index_of(system)]; ++number) {
      const SatelliteId id{system, static_cast<std::uint16_t>(number)};
      REQUIRE(is_valid(id));
      REQUIRE(to_string(id).size() == 3);
      REQUIRE(satellite_from_string(to_string(id)) == id);
    }
    CHECK_FALSE(is_valid({system, 0}));
    CHECK_FALSE(is_valid({system, static_cast<std::uint16_t>(highest[index_of(system)] + 1)}));
    CHECK(system_from_string(to_string(system)) == system);
  }
}

TEST_CASE("LEO names go on through the letters L, M, N, O", "[satellite]") {
  const auto leo = [](int number) {
    return SatelliteId{System::kLeo, static_cast<std::uint16_t>(number)};
  };
  CHECK(to_string(leo(1)) == "L01");
  CHECK(to_string(leo(99)) == "L99");
  CHECK(to_string(leo(100)) == "M00");
  CHECK(to_string(leo(199)) == "M99");
  CHECK(to_string(leo(200)) == "N00");
  CHECK(to_string(leo(399)) == "O99");
  CHECK(satellite_from_string("M07") == leo(107));
  CHECK(satellite_from_string("N 5") == leo(205));
}

TEST_CASE("A blank tens digit is a zero", "[satellite]") {
  CHECK(satellite_from_string("G 5") == SatelliteId{System::kGps, 5});
  CHECK(satellite_from_string("C62") == SatelliteId{System::kBeidou, 62});
}

TEST_CASE("Other text is no satellite", "[satellite]") {
  using namespace std::string_view_literals;
  for (const std::string_view name :
       {""sv,    "G"sv,   "G1"sv,  "G001"sv, "G00"sv, "G64"sv,    "E51"sv,         "C64"sv,
        "L00"sv, "P01"sv, "R01"sv, "S23"sv,  "J01"sv, "I01"sv,    "g01"sv,         "5 G"sv,
        "G5 "sv, "G-1"sv, "G+1"sv, "G1x"sv,  "   "sv, "G\0001"sv, "\xff\xff\xff"sv}) {
    INFO(name);
    CHECK_FALSE(satellite_from_string(name).has_value());
  }
  CHECK_FALSE(system_from_string("glonass").has_value());
  CHECK_FALSE(system_from_string("").has_value());
}

TEST_CASE("What came from the wire with an unknown system is not valid and still prints",
          "[satellite]") {
  const SatelliteId id{static_cast<System>(200), 1};
  CHECK_FALSE(is_valid(id));
  CHECK(to_string(id) == "???");
  CHECK(to_string(id.system) == "unknown");
  CHECK_FALSE(is_beidou_geostationary(id));
}

TEST_CASE("every satellite that has a name has a place of its own", "[satellite]") {
  std::size_t next = 0;
  for (const System system : kSystems)
    for (std::uint16_t n = 1; is_valid({system, n}); ++n)
      CHECK(table_index_of({system, n}) == next++);
  CHECK(next == kMaxEphemerisSatellites);
}

TEST_CASE("BeiDou's geostationary satellites", "[satellite]") {
  int count = 0;
  for (std::uint16_t n = 1; n <= 63; ++n) count += is_beidou_geostationary({System::kBeidou, n});
  CHECK(count == 10);
  CHECK(is_beidou_geostationary({System::kBeidou, 5}));
  CHECK(is_beidou_geostationary({System::kBeidou, 59}));
  CHECK_FALSE(is_beidou_geostationary({System::kBeidou, 6}));
  CHECK_FALSE(is_beidou_geostationary({System::kGps, 5}));
}

}  // namespace leonav
