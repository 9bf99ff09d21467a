// Antenna patterns on the wire: there and back bit for bit, and nothing a hostile message says is
// believed.
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "drivers/lcm/decode.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/wire.h"
#include "support/catch.h"

using namespace leonav;

namespace {

using Bytes = std::vector<std::uint8_t>;

AntennaPattern pattern_of(bool is_receiver) {
  AntennaPattern pattern;
  pattern.is_receiver = is_receiver;
  pattern.satellite = {System::kGalileo, static_cast<std::uint16_t>(is_receiver ? 0 : 11)};
  pattern.band = '5';
  if (!is_receiver) {
    pattern.valid_from = GpsTime::from_week_and_tow(2000, 1.0);
    pattern.valid_until = GpsTime::from_week_and_tow(2300, 2.0);
  }
  pattern.offset_m = {0.1, -0.02, 0.8};
  AntennaGrid& grid = pattern.variation;
  grid.angles = is_receiver ? 19 : 41;
  grid.azimuths = is_receiver ? 73 : 1;
  grid.angle_step = is_receiver ? 0.0873 : 0.0087;
  for (int i = 0; i < grid.angles * grid.azimuths; ++i) {
    grid.values.push_back(1e-5F * static_cast<float>(i % 977));
  }
  return pattern;
}

Bytes encoded(const AntennaPattern& pattern) {
  Encoder encoder;
  const ByteSpan bytes = encoder.encode(pattern, GpsTime::from_week_and_tow(2111, 0.0), 7);
  return {bytes.begin(), bytes.end()};
}

InputFault fault_of(const AntennaPattern& pattern) {
  Decoder decoder;
  AntennaPattern out;
  return decoder.decode(encoded(pattern), &out).fault;
}

}  // namespace

TEST_CASE("Antenna patterns come back whole at full capacity") {
  for (const bool is_receiver : {false, true}) {
    const AntennaPattern in = pattern_of(is_receiver);
    const Bytes bytes = encoded(in);
    CHECK(bytes.size() <= wire::kMaxMessageBytes);
    Decoder decoder;
    AntennaPattern out;
    const DecodeResult result = decoder.decode(bytes, &out);
    REQUIRE(result.fault == InputFault::kNone);
    CHECK(result.sequence == 7);
    CHECK(out.is_receiver == in.is_receiver);
    CHECK(out.satellite == in.satellite);
    CHECK(out.band == in.band);
    CHECK(out.valid_from == in.valid_from);
    CHECK(out.valid_until == in.valid_until);
    CHECK(out.offset_m == in.offset_m);
    CHECK(out.variation.first_angle == in.variation.first_angle);
    CHECK(out.variation.angle_step == in.variation.angle_step);
    CHECK(out.variation.angles == in.variation.angles);
    CHECK(out.variation.azimuths == in.variation.azimuths);
    CHECK(out.variation.values == in.variation.values);
  }
}

TEST_CASE("An antenna message that no antenna has is refused") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  AntennaPattern pattern = pattern_of(false);
  pattern.variation.values[3] = nan;
  CHECK(fault_of(pattern) == InputFault::kNotFinite);
  pattern = pattern_of(false);
  pattern.offset_m.x() = nan;
  CHECK(fault_of(pattern) == InputFault::kNotFinite);
  pattern.offset_m.x() = 1e3;
  CHECK(fault_of(pattern) == InputFault::kNotSane);
  pattern = pattern_of(false);
  pattern.satellite.number = 999;
  CHECK(fault_of(pattern) == InputFault::kNotSane);
  pattern = pattern_of(false);
  pattern.satellite.system = static_cast<System>(77);
  CHECK(fault_of(pattern) == InputFault::kOutOfRange);
  pattern = pattern_of(false);
  pattern.variation.angles = 40;
  CHECK(fault_of(pattern) == InputFault::kNotSane);
  pattern = pattern_of(true);
  pattern.is_receiver = false;  // a satellite's with a receiver's grid
  pattern.satellite.number = 11;
  CHECK(fault_of(pattern) == InputFault::kNotSane);
  pattern = pattern_of(false);
  pattern.valid_until = GpsTime::from_nanoseconds(-1);
  CHECK(fault_of(pattern) == InputFault::kOutOfRange);
}

TEST_CASE("Antenna counts, cuts and flipped bits do no harm") {
  const Bytes good = encoded(pattern_of(false));
  Decoder decoder;
  AntennaPattern out;
  for (const std::uint32_t count : {0x7fffffffU, 0xffffffffU, 1388U, 42U, 40U, 0U}) {
    Bytes bytes = good;
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[wire::kFirstCountOffset + i] = static_cast<std::uint8_t>(count >> (24 - 8 * i));
    }
    CHECK(decoder.decode(bytes, &out).fault != InputFault::kNone);
  }
  for (std::size_t size = 0; size < good.size(); ++size) {
    CHECK(decoder.decode(ByteSpan(good).first(size), &out).fault != InputFault::kNone);
  }
  std::mt19937 random(3);
  for (int i = 0; i < 20000; ++i) {
    Bytes bytes = good;
    for (int flips = 0; flips < 1 + i % 4; ++flips) {
      bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    if (decoder.decode(bytes, &out).fault == InputFault::kNone) REQUIRE(is_storable(out));
  }
}
