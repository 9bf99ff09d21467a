// Messages of type 1: the examples of the interface document, and messages made here field by
// field.
#include "drivers/has/has_message.h"

#include <random>

#include "annex_d.h"
#include "support/catch.h"
#include "support/pages/page_bits.h"

namespace leonav {
namespace {

using test::PageBits;

const GpsTime kReceived = GpsTime::from_week_and_tow(2269, 532'802.0);  // 148 h and 2 s

struct Decoded {
  HasStatus status = HasStatus::kOk;
  std::vector<SsrMessage> messages;
};

Decoded decode(HasMessages* decoder, const std::vector<std::uint8_t>& octets, HasLeftOut* left_out,
               GpsTime received = kReceived) {
  Decoded result;
  result.status = decoder->decode(octets, received, &result.messages, left_out);
  return result;
}

Decoded decode(HasMessages* decoder, const std::vector<std::uint8_t>& octets) {
  HasLeftOut left_out;
  return decode(decoder, octets, &left_out);
}

// Satellites G02, G05 with 1C and 2L, and E01, E11, E36 with 1C, 5Q, 6C, of which E11 lacks 5Q.
PageBits with_mask(std::uint32_t flags, std::uint32_t mask_id = 7, std::uint32_t issue = 3) {
  PageBits bits;
  bits.header(0, 32 | flags, mask_id, issue).add(2, 4);
  bits.add(0, 4).flags(40, {2, 5}, 1).flags(16, {0, 7}, 0).add(0, 1).add(0, 3);
  bits.add(2, 4).flags(40, {1, 11, 36}, 1).flags(16, {1, 4, 13}, 0).add(1, 1);
  bits.add(0b111, 3).add(0b101, 3).add(0b111, 3).add(0, 3);
  return bits.add(0, 6);
}

}  // namespace

TEST_CASE("The examples of the interface document decode to their contents") {
  if (!test::have_shared_data(test::kAnnexD)) return;
  HasMessages decoder;
  const test::AnnexExample first = test::annex_example(1), second = test::annex_example(2);
  const Decoded one = decode(&decoder, first.octets);
  REQUIRE(one.status == HasStatus::kOk);
  // Orbits and biases of two systems; no phase bias is available.
  REQUIRE(one.messages.size() == 6);
  CHECK(one.messages[0].validity_s == 300.0);
  CHECK(one.messages[2].validity_s == 3600.0);
  CHECK(one.messages[4].validity_s == 60.0);
  CHECK(one.messages[0].issue == 11);
  CHECK(one.messages[0].solution == 0);
  CHECK(one.messages[0].time == GpsTime::from_week_and_tow(2269, 532'800.0));

  std::vector<SsrSatellite> orbits = one.messages[0].satellites;
  orbits.insert(orbits.end(), one.messages[1].satellites.begin(), one.messages[1].satellites.end());
  const auto orbit_rows = test::annex_rows(first.contents, "ORBIT CORRECTIONS", "CODE BIASES");
  REQUIRE(orbit_rows.size() == orbits.size());
  REQUIRE(orbits.size() == 53);
  for (std::size_t i = 0; i < orbits.size(); ++i) {
    const auto& [name, row] = orbit_rows[i];
    REQUIRE(to_string(orbits[i].satellite) == name);
    REQUIRE(row.size() == 4);
    const bool is_available = row[1] > -10.24;
    REQUIRE(orbits[i].orbit.has_value() == is_available);
    CHECK(orbits[i].orbit_ends == !is_available);
    if (!is_available) continue;
    CHECK(orbits[i].orbit->issue == row[0]);
    for (int k = 0; k < 3; ++k) {
      CHECK(orbits[i].orbit->delta_rac_m[k] ==
            Approx(-row[static_cast<std::size_t>(k) + 1]).margin(1e-9));
    }
  }
  std::vector<SsrSatellite> biases = one.messages[2].satellites;
  biases.insert(biases.end(), one.messages[3].satellites.begin(), one.messages[3].satellites.end());
  const auto bias_rows = test::annex_rows(first.contents, "CODE BIASES", "PHASE BIASES");
  REQUIRE(bias_rows.size() == biases.size());
  for (std::size_t i = 0; i < biases.size(); ++i) {
    const auto& [name, row] = bias_rows[i];
    REQUIRE(to_string(biases[i].satellite) == name);
    REQUIRE(biases[i].code_biases.size() == row.size());
    for (std::size_t k = 0; k < row.size(); ++k) {
      CHECK(biases[i].code_biases[k].bias_m == Approx(row[k]).margin(1e-9));
    }
  }
  CHECK(to_string(biases[0].code_biases[1].code) == "2L");
  CHECK(to_string(biases.back().code_biases[3].code) == "6C");

  // The second example refers to the mask of the first one; its values are before multiplication.
  const Decoded two = decode(&decoder, second.octets);
  REQUIRE(two.status == HasStatus::kOk);
  REQUIRE(two.messages.size() == 2);
  const auto clock_rows = test::annex_rows(second.contents, "Delta Clock C0", "END MESSAGE BODY");
  REQUIRE(clock_rows.size() == 53);
  std::size_t i = 0;
  for (const SsrMessage& message : two.messages) {
    const double multiplier = message.system == System::kGps ? 3.0 : 1.0;
    for (const SsrSatellite& satellite : message.satellites) {
      const auto& [name, row] = clock_rows[i++];
      REQUIRE(to_string(satellite.satellite) == name);
      REQUIRE(satellite.clock.has_value() == (row[0] > -10.24));
      if (satellite.clock) {
        CHECK(satellite.clock->c0_m == Approx(multiplier * row[0]).margin(1e-9));
      }
    }
  }
}

TEST_CASE("A subset has clocks of some satellites of the mask") {
  HasMessages decoder;
  PageBits bits = with_mask(4);
  bits.add(4, 4).add(1, 4).add(2, 4).add(3, 2).add(0b101, 3).signed_number(-5, 13);
  bits.signed_number(4095, 13);
  HasLeftOut left_out;
  const Decoded result = decode(&decoder, bits.octets(), &left_out);
  REQUIRE(result.status == HasStatus::kOk);
  REQUIRE(result.messages.size() == 1);
  const SsrMessage& m = result.messages[0];
  CHECK(m.kind == SsrKind::kClock);
  CHECK(m.validity_s == 30.0);
  REQUIRE(m.satellites.size() == 2);
  CHECK(m.satellites[0].satellite == SatelliteId{System::kGalileo, 1});
  CHECK(m.satellites[0].clock->c0_m == Approx(-0.05));
  CHECK(m.satellites[1].satellite == SatelliteId{System::kGalileo, 36});
  CHECK_FALSE(m.satellites[1].clock);
  CHECK(m.satellites[1].clock_ends);
  CHECK(left_out.do_not_use == 1);
}

TEST_CASE("Phase biases are cycles on the wire and metres behind it, of the cells of the mask") {
  HasMessages decoder;
  PageBits bits = with_mask(1);
  bits.add(5, 4);
  for (int cell = 0; cell < 4; ++cell) bits.signed_number(100 + cell, 11).add(2, 2);
  for (int cell = 0; cell < 8; ++cell) bits.signed_number(-1024 * (cell == 3), 11).add(1, 2);
  HasLeftOut left_out;
  const Decoded result = decode(&decoder, bits.octets(), &left_out);
  REQUIRE(result.status == HasStatus::kOk);
  REQUIRE(result.messages.size() == 2);
  const auto& gps = result.messages[0].satellites[0].phase_biases;
  REQUIRE(gps.size() == 2);
  CHECK(gps[0].bias_m == Approx(299'792'458.0 / 1575.42e6));
  CHECK(gps[1].bias_m == Approx(1.01 * 299'792'458.0 / 1227.60e6));
  CHECK(gps[1].discontinuities == 2);
  const auto& galileo = result.messages[1].satellites;
  REQUIRE(galileo[1].phase_biases.size() == 1);  // its first one is not available
  CHECK(to_string(galileo[1].phase_biases[0].code) == "6C");
  CHECK(left_out.unavailable == 1);
}

TEST_CASE("A message is of the mask with its number, for an hour") {
  HasMessages decoder;
  PageBits clocks;
  clocks.header(57, 8, 7, 3).add(5, 4).add(0, 4);
  for (int i = 0; i < 5; ++i) clocks.signed_number(i, 13);
  CHECK(decode(&decoder, clocks.octets()).status == HasStatus::kWithoutMask);
  REQUIRE(decode(&decoder, with_mask(0).octets()).status == HasStatus::kOk);
  const Decoded result = decode(&decoder, clocks.octets());
  REQUIRE(result.status == HasStatus::kOk);
  CHECK(result.messages[0].satellites.size() == 2);
  CHECK(result.messages[1].satellites.size() == 3);
  CHECK(result.messages[1].satellites[2].clock->c0_m == Approx(0.01));
  HasLeftOut left_out;
  CHECK(decode(&decoder, clocks.octets(), &left_out, kReceived.plus_seconds(3601)).status ==
        HasStatus::kWithoutMask);
  PageBits other;
  other.header(57, 8, 8, 3);
  CHECK(decode(&decoder, other.octets()).status == HasStatus::kWithoutMask);
}

TEST_CASE("The hour of a message is the one nearest to its reception") {
  HasMessages decoder;
  PageBits early;
  early.header(1, 32 | 8, 7, 0).add(1, 4).add(0, 4).flags(40, {9}, 1).flags(16, {0}, 0);
  early.add(0, 4).add(0, 6).add(5, 4).add(0, 2).add(0, 13);
  HasLeftOut left_out;
  const GpsTime end_of_week = GpsTime::from_week_and_tow(2269, 604'799.0);
  const Decoded result = decode(&decoder, early.octets(), &left_out, end_of_week);
  REQUIRE(result.status == HasStatus::kOk);
  REQUIRE(result.messages.size() == 1);
  CHECK(result.messages[0].time == GpsTime::from_week_and_tow(2270, 1.0));
  const Decoded before =
      decode(&decoder, early.octets(), &left_out, end_of_week.plus_seconds(-1799));
  REQUIRE(before.messages.size() == 1);
  CHECK(before.messages[0].time == GpsTime::from_week_and_tow(2269, 601'201.0));
}

TEST_CASE("What no message may hold is refused, and leaves no trace") {
  HasMessages decoder;
  PageBits late;
  CHECK(decode(&decoder, late.header(3600, 0, 0, 0).octets()).status == HasStatus::kBadTime);
  PageBits other;
  other.header(0, 32, 1, 0).add(1, 4).add(3, 4).add(0, 200);
  CHECK(decode(&decoder, other.octets()).status == HasStatus::kBadMask);
  PageBits twice;
  twice.header(0, 32, 1, 0).add(2, 4);
  for (int i = 0; i < 2; ++i) twice.add(0, 4).flags(40, {3}, 1).flags(16, {0}, 0).add(0, 4);
  CHECK(decode(&decoder, twice.add(0, 6).octets()).status == HasStatus::kBadMask);
  CHECK(decode(&decoder, with_mask(16).add(15, 4).add(0, 400).octets()).status ==
        HasStatus::kBadValidity);
  CHECK(decode(&decoder, with_mask(4).add(5, 4).add(1, 4).add(5, 4).octets()).status ==
        HasStatus::kBadSubset);
  // No mask of the refused ones was kept.
  PageBits clocks;
  CHECK(decode(&decoder, clocks.header(0, 8, 7, 3).octets()).status == HasStatus::kWithoutMask);
}

TEST_CASE("A message that ends early gives nothing, wherever it ends") {
  PageBits bits = with_mask(16 | 2);
  bits.add(5, 4);
  for (int i = 0; i < 2; ++i) bits.add(1, 8).signed_number(1, 13).add(0, 24);
  for (int i = 0; i < 3; ++i) bits.add(1, 10).signed_number(1, 13).add(0, 24);
  bits.add(5, 4);
  for (int i = 0; i < 12; ++i) bits.add(7, 11);
  const std::vector<std::uint8_t> whole = bits.octets();
  HasMessages good;
  REQUIRE(decode(&good, whole).messages.size() == 4);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    HasMessages decoder;
    const std::vector<std::uint8_t> cut(whole.begin(),
                                        whole.begin() + static_cast<std::ptrdiff_t>(length));
    const Decoded result = decode(&decoder, cut);
    INFO(length);
    CHECK(result.messages.empty());
    CHECK(result.status != HasStatus::kOk);
  }
}

TEST_CASE("Any octets are survived") {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> octet(0, 255), length(0, 32 * 53);
  HasMessages decoder;
  std::size_t largest = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> octets(static_cast<std::size_t>(length(random)));
    for (std::uint8_t& one : octets) one = static_cast<std::uint8_t>(octet(random));
    if (octets.size() > 5) octets[4] = 0x10;  // one system, GPS
    largest = std::max(largest, decode(&decoder, octets).messages.size());
  }
  CHECK(largest > 0);  // some of them are messages
  CHECK(largest <= 60);
}

}  // namespace leonav
