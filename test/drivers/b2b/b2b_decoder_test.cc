// Messages of PPP-B2b made here field by field: masks, issues, marks, and everything damaged.
#include "drivers/b2b/b2b_decoder.h"

#include <random>

#include "support/catch.h"
#include "support/pages/page_bits.h"

namespace leonav {
namespace {

// 04:00:10 of a day in BeiDou's time.
const GpsTime kTime = GpsTime::from_week_and_tow(2269, 6 * 86'400.0 + 14'410.0 + 14.0);
constexpr SatelliteId kC60{System::kBeidou, 60};

test::PageBits head(std::uint32_t type, std::uint32_t tod_s, std::uint32_t issue) {
  test::PageBits bits;
  return bits.add(type, 6).add(tod_s, 17).add(0, 4).add(issue, 2);
}

struct Rig {
  std::vector<SsrMessage> add(const test::PageBits& bits, double after_s = 0.0,
                              SatelliteId from = kC60) {
    return decoder.add(bits.page(PageService::kBeidouB2b, from, kTime.plus_seconds(after_s)));
  }
  // A mask of C19, G01, G32 and E05.
  void add_mask(std::uint32_t iodp, std::uint32_t issue) {
    CHECK(add(head(1, 14'400, issue).add(iodp, 4).flags(174, {19, 64, 95, 105}, 1)).empty());
  }
  B2bDecoder decoder;
};

// Clocks of the mask's first four, of the message with the number `part`.
test::PageBits clocks(std::uint32_t iodp, std::uint32_t issue, std::uint32_t part = 0) {
  test::PageBits bits = head(4, 14'406, issue);
  bits.add(iodp, 4).add(part, 5);
  bits.add(1, 3).signed_number(100, 15).add(2, 3).signed_number(-100, 15);
  bits.add(3, 3).signed_number(-16'383, 15).add(4, 3).signed_number(7, 15);
  return bits;
}

}  // namespace

TEST_CASE("Slots and modes have the names of the interface document") {
  CHECK(satellite_from_b2b(63) == SatelliteId{System::kBeidou, 63});
  CHECK(satellite_from_b2b(64) == SatelliteId{System::kGps, 1});
  CHECK(satellite_from_b2b(100) == SatelliteId{System::kGps, 37});
  CHECK(satellite_from_b2b(101) == SatelliteId{System::kGalileo, 1});
  CHECK(satellite_from_b2b(137) == SatelliteId{System::kGalileo, 37});
  CHECK_FALSE(satellite_from_b2b(138));
  CHECK_FALSE(satellite_from_b2b(0));
  CHECK(to_string(*signal_from_b2b(System::kBeidou, 12)) == "6I");
  CHECK(to_string(*signal_from_b2b(System::kGps, 13)) == "5X");
  CHECK(to_string(*signal_from_b2b(System::kGalileo, 4)) == "5Q");
  CHECK_FALSE(signal_from_b2b(System::kGps, 2));
  CHECK_FALSE(signal_from_b2b(System::kGps, 16));
  CHECK_FALSE(signal_from_b2b(System::kLeo, 0));
}

TEST_CASE("Orbits name their satellites, and have URA and the issues of both messages") {
  Rig rig;
  test::PageBits bits = head(2, 14'400, 2);
  bits.add(64, 9).add(0x234, 10).add(5, 3);
  bits.signed_number(-10, 15).signed_number(20, 13).signed_number(-30, 13).add(0b010011, 6);
  bits.add(105, 9).add(0x234, 10).add(6, 3);
  bits.signed_number(-16'383, 15).signed_number(20, 13).signed_number(0, 13).add(1, 6);
  bits.add(150, 9).add(0, 10 + 3 + 15 + 26 + 6);
  const std::vector<SsrMessage> messages = rig.add(bits);
  REQUIRE(messages.size() == 2);
  const SsrMessage& gps = messages[0];
  CHECK(gps.kind == SsrKind::kOrbit);
  CHECK(gps.system == System::kGps);
  CHECK(gps.service == SsrService::kBeidouB2b);
  CHECK(gps.time == GpsTime::from_week_and_tow(2269, 6 * 86'400.0 + 14'414.0));
  CHECK(gps.validity_s == 96.0);
  CHECK(gps.at_antenna == true);
  CHECK(gps.issue == 2);
  const SsrOrbit& orbit = *gps.satellites[0].orbit;
  CHECK(orbit.issue == 0x34);
  CHECK(orbit.correction_issue == 5);
  CHECK(orbit.axes == OrbitAxes::kRadial);
  CHECK(orbit.delta_rac_m.x() == Approx(-0.016));
  CHECK(orbit.delta_rac_m.y() == Approx(0.128));
  CHECK(orbit.delta_rac_m.z() == Approx(-0.192));
  CHECK(gps.satellites[0].accuracy_index == 19);
  CHECK(messages[1].satellites[0].satellite == SatelliteId{System::kGalileo, 5});
  CHECK(messages[1].satellites[0].orbit_ends);
  CHECK_FALSE(messages[1].satellites[0].orbit);
  CHECK(rig.decoder.counters().other_systems == 1);
  CHECK(rig.decoder.counters().unavailable == 1);
}

TEST_CASE("Clocks are those of the mask with their issues, and have the opposite sign") {
  Rig rig;
  CHECK(rig.add(clocks(5, 1)).empty());
  rig.add_mask(5, 1);
  CHECK(rig.add(clocks(4, 1)).empty());
  CHECK(rig.add(clocks(5, 2)).empty());
  CHECK(rig.decoder.counters().without_mask == 3);
  const std::vector<SsrMessage> messages = rig.add(clocks(5, 1), 5.0);
  REQUIRE(messages.size() == 3);
  CHECK(messages[0].system == System::kBeidou);
  CHECK(messages[0].validity_s == 12.0);
  CHECK(messages[0].satellites[0].clock->c0_m == Approx(-0.16));
  CHECK(messages[0].satellites[0].clock->correction_issue == 1);
  REQUIRE(messages[1].satellites.size() == 2);
  CHECK(messages[1].satellites[0].satellite == SatelliteId{System::kGps, 1});
  CHECK(messages[1].satellites[0].clock->c0_m == Approx(0.16));
  CHECK(messages[1].satellites[1].clock_ends);
  CHECK(messages[2].satellites[0].clock->correction_issue == 4);
  // The mask has no second part, and is forgotten.
  CHECK(rig.add(clocks(5, 1, 1)).empty());
  CHECK(rig.add(clocks(5, 1), 3700.0).empty());
  CHECK(rig.decoder.counters().without_mask == 4);
}

TEST_CASE("Biases have the opposite sign, and those that are not there are left out") {
  Rig rig;
  test::PageBits bits = head(3, 14'400, 0);
  bits.add(2, 5).add(64, 9).add(3, 4);
  bits.add(0, 4).signed_number(100, 12).add(2, 4).signed_number(5, 12).add(12, 4);
  bits.signed_number(-2047, 12);
  bits.add(174, 9).add(1, 4).add(0, 4).signed_number(1, 12);
  const std::vector<SsrMessage> messages = rig.add(bits);
  REQUIRE(messages.size() == 1);
  REQUIRE(messages[0].satellites.size() == 1);
  const auto& biases = messages[0].satellites[0].code_biases;
  REQUIRE(biases.size() == 1);
  CHECK(to_string(biases[0].code) == "1C");
  CHECK(biases[0].bias_m == Approx(-1.7));
  CHECK(rig.decoder.counters().unavailable == 1);
  CHECK(rig.decoder.counters().reserved_signals == 1);
  CHECK(rig.decoder.counters().other_systems == 1);
}

TEST_CASE("The day of a message is the one nearest to its reception") {
  Rig rig;
  test::PageBits bits = head(2, 86'390, 0);
  bits.add(64, 9).add(0, 10 + 3 + 15 + 26 + 6);
  // Twenty seconds after the end of a day of BeiDou.
  const double after_s = 86'400.0 - 14'410.0 + 20.0;
  const std::vector<SsrMessage> messages = rig.add(bits, after_s);
  REQUIRE(messages.size() == 1);
  CHECK(messages[0].time == kTime.plus_seconds(after_s - 30.0));
}

TEST_CASE("Pages without corrections are counted by their reason") {
  Rig rig;
  rig.add_mask(5, 1);
  CHECK(rig.add(head(63, 0, 0)).empty());
  CHECK(rig.add(head(6, 14'400, 0)).empty());
  CHECK(rig.add(head(0, 14'400, 0)).empty());
  CHECK(rig.add(head(2, 86'400, 0)).empty());
  CHECK(rig.add(clocks(5, 1), 0.0, {System::kGps, 5}).empty());
  CHECK(rig.add(clocks(5, 1)).size() == 3);
  CHECK(rig.add(clocks(5, 1), 1.0, {System::kBeidou, 59}).empty());
  // Thirty-one satellites with fifteen biases each do not fit.
  test::PageBits full = head(3, 14'400, 0);
  full.add(31, 5);
  for (int i = 0; i < 7; ++i) full.add(64, 9).add(15, 4).add(0, 48);
  CHECK(rig.add(full).empty());
  CorrectionPage damaged =
      clocks(5, 1).page(PageService::kBeidouB2b, kC60, kTime.plus_seconds(20.0));
  damaged.bits[9] ^= 4;
  CHECK(rig.decoder.add(damaged).empty());
  CHECK(rig.decoder.add(clocks(5, 1).page(PageService::kBeidouB2b, kC60, GpsTime())).empty());
  const B2bCounters& c = rig.decoder.counters();
  CHECK(c.empty == 1);
  CHECK(c.other_types.at(6) == 1);
  CHECK(c.other_types.at(0) == 1);
  CHECK(c.bad_time == 1);
  CHECK(c.bad_satellites == 1);
  CHECK(c.repeated == 1);
  CHECK(c.bad_length == 1);
  CHECK(c.bad_checksums == 1);
  CHECK(c.without_time == 1);
  CHECK(c.messages == 2);
}

TEST_CASE("Any content is survived") {
  Rig rig;
  std::mt19937 random(5);
  std::uniform_int_distribution<std::uint64_t> any(0, 0xFFFF), type(1, 4);
  std::size_t largest = 0;
  for (int i = 0; i < 3000; ++i) {
    test::PageBits bits;
    bits.add(type(random), 6);
    for (int k = 0; k < 28; ++k) bits.add(any(random), 16);
    for (const SsrMessage& m : rig.add(bits, i * 10.0)) {
      largest = std::max(largest, m.satellites.size());
    }
  }
  CHECK(largest > 5);
  CHECK(largest <= 31);
}

}  // namespace leonav
