// VectorNav messages, whole and damaged. The encoder here puts fields one after the other as the
// manual's tables have them; the manual's example message is the oracle of the checksum.
#include "drivers/vectornav/vectornav_decoder.h"

#include <bit>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "drivers/binary/crc16.h"
#include "support/bytes/bytes.h"
#include "support/catch.h"

namespace leonav {
namespace {

using test::Bytes;
using test::put;

class VectornavCollector : public VectornavHandler {
 public:
  void on_measurement(const VectornavMeasurement& measurement) override {
    measurements.push_back(measurement);
  }
  std::vector<VectornavMeasurement> measurements;
};

Bytes vectornav_message(std::uint8_t groups, const std::vector<std::uint16_t>& masks,
                        const Bytes& payload) {
  Bytes bytes = {0xFA, groups};
  for (const std::uint16_t mask : masks) put(&bytes, mask, 2);
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  const std::uint16_t crc = crc16(std::span(bytes).subspan(1));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  return bytes;
}

void put_floats(Bytes* bytes, const std::vector<float>& values) {
  for (const float value : values) put(bytes, std::bit_cast<std::uint32_t>(value), 4);
}

constexpr std::uint64_t kGpsTime_ns = 1'300'000'000'123'456'789;

// TimeStartup, TimeGps and DeltaTheta of the common group; the first increment is `mark` degrees.
Bytes increments(float mark) {
  Bytes payload;
  put(&payload, 42'000'000, 8);
  put(&payload, kGpsTime_ns, 8);
  put_floats(&payload, {0.005F, mark, 2.0F, -3.0F, 0.25F, -0.5F, -0.049F});
  return vectornav_message(0x01, {1 << 0 | 1 << 1 | 1 << 11}, payload);
}

VectornavCollector decode_vectornav(const Bytes& bytes, std::size_t chunk,
                                    VectornavCounters* counters = nullptr) {
  VectornavDecoder decoder;
  VectornavCollector collector;
  for (std::size_t i = 0; i < bytes.size(); i += chunk) {
    decoder.feed(std::span(bytes).subspan(i, std::min(chunk, bytes.size() - i)), &collector);
  }
  decoder.finish(&collector);
  if (counters != nullptr) *counters = decoder.counters();
  return collector;
}

}  // namespace

TEST_CASE("The manual's example message has the checksum that is computed", "[vectornav]") {
  const Bytes example = {0x01, 0x08, 0x00, 0x93, 0x50, 0x2E, 0x42, 0x83,
                         0x3E, 0xF1, 0x3F, 0x48, 0xB5, 0x04, 0xBB};
  CHECK(crc16(example) == 0x9288);
}

TEST_CASE("Increments come with GPS time and the sensor's clock", "[vectornav]") {
  const VectornavCollector found = decode_vectornav(increments(1.0F), 1);
  REQUIRE(found.measurements.size() == 1);
  const VectornavMeasurement& m = found.measurements[0];
  CHECK(m.gps_time->nanoseconds() == static_cast<std::int64_t>(kGpsTime_ns));
  CHECK(m.startup_ns == 42'000'000);
  REQUIRE(m.increments);
  CHECK(m.increments->interval_s == static_cast<double>(0.005F));
  CHECK(m.increments->delta_theta_rad[2] == Approx(-3.0 * std::numbers::pi / 180.0));
  CHECK(m.increments->delta_velocity_m_s[0] == 0.25);
  CHECK_FALSE(m.rates);
}

TEST_CASE("Fields of the time and IMU groups are found behind those of others", "[vectornav]") {
  // Common: YawPitchRoll. Time: TimeGps, TimeSyncIn, TimeUtc, SyncInCnt, TimeStatus. IMU:
  // UncompMag, UncompAccel, UncompGyro, Temp, Accel, AngularRate.
  Bytes payload;
  put_floats(&payload, {10.0F, 20.0F, 30.0F});
  put(&payload, kGpsTime_ns, 8);
  put(&payload, 250'000'000, 8);
  for (const int part : {21, 3, 18, 7, 6, 22}) put(&payload, static_cast<std::uint64_t>(part), 1);
  put(&payload, 500, 2);
  put(&payload, 77, 4);
  const std::size_t status = payload.size();
  put(&payload, 7, 1);
  put_floats(&payload, {9.0F, 9.0F, 9.0F, 1.0F, 2.0F, -9.8F, 0.1F, 0.2F, 0.3F, 25.0F, 7.0F, 7.0F,
                        7.0F, 8.0F, 8.0F, 8.0F});
  const std::vector<std::uint16_t> masks = {1 << 3, 1 << 1 | 1 << 4 | 1 << 6 | 1 << 7 | 1 << 9,
                                            1 << 1 | 1 << 2 | 1 << 3 | 1 << 4 | 1 << 9 | 1 << 10};
  const auto found = decode_vectornav(vectornav_message(0x07, masks, payload), 7).measurements;
  REQUIRE(found.size() == 1);
  CHECK(found[0].gps_time);
  CHECK(found[0].since_pulse_ns == 250'000'000);
  CHECK(found[0].pulses == 77);
  // 2021-03-18 07:06:22.5 UTC is 18 s later in GPS time, in the fifth day of week 2149.
  REQUIRE(found[0].utc_time);
  CHECK(found[0].utc_time->week() == 2149);
  CHECK(found[0].utc_time->tow_s() == 4 * 86400 + 7 * 3600 + 6 * 60 + 40.5);
  REQUIRE(found[0].rates);
  CHECK(found[0].rates->angular_rate_rad_s[1] == static_cast<double>(0.2F));
  CHECK(found[0].rates->specific_force_m_s2[2] == static_cast<double>(-9.8F));

  SECTION("a time that the sensor marks as not valid does not count") {
    payload[status] = 0;
    const auto marked = decode_vectornav(vectornav_message(0x07, masks, payload), 7).measurements;
    REQUIRE(marked.size() == 1);
    CHECK_FALSE(marked[0].gps_time);
    CHECK_FALSE(marked[0].utc_time);
  }
}

TEST_CASE("Values beyond any sensor are counted and left out", "[vectornav]") {
  VectornavCounters counters;
  const float infinite = INFINITY;
  CHECK(decode_vectornav(increments(infinite), 64, &counters).measurements.empty());
  CHECK(counters.bad_values == 1);
  CHECK(decode_vectornav(increments(400.0F), 64, &counters).measurements.empty());
  CHECK(counters.bad_values == 1);
}

TEST_CASE("Damage costs the message that it is in and no other, in chunks of any size",
          "[vectornav]") {
  constexpr std::size_t kMessages = 400;
  Bytes stream;
  std::vector<bool> is_damaged(kMessages, false);
  std::mt19937 dice(1);
  for (std::size_t i = 0; i < kMessages; ++i) {
    Bytes one = increments(static_cast<float>(i) * 0.001F);
    if (dice() % 4 == 0) {
      one[dice() % one.size()] ^= static_cast<std::uint8_t>(1U << dice() % 8);
      is_damaged[i] = true;
    }
    // False starts, one of which claims a longer message than there is, and bytes of nobody.
    if (dice() % 5 == 0) stream.insert(stream.end(), {0xFA, 0x01, 0xFF, 0x7F});
    if (dice() % 5 == 0) stream.insert(stream.end(), {0xFA, 0x80, 0x00, 0xFA});
    stream.insert(stream.end(), one.begin(), one.end());
  }
  for (const std::size_t chunk : {1, 13, 4096}) {
    VectornavCounters counters;
    const VectornavCollector found = decode_vectornav(stream, chunk, &counters);
    std::size_t next = 0, expected = 0;
    for (std::size_t i = 0; i < kMessages; ++i) {
      if (is_damaged[i]) continue;
      ++expected;
      REQUIRE(next < found.measurements.size());
      const double mark = static_cast<double>(static_cast<float>(i) * 0.001F);
      CHECK(found.measurements[next++].increments->delta_theta_rad[0] ==
            Approx(mark * std::numbers::pi / 180.0).margin(1e-12));
    }
    CHECK(found.measurements.size() == expected);
    CHECK(counters.framer.messages == expected);
    CHECK(counters.framer.bad_checksums > 0);
    CHECK(counters.framer.unknown_fields > 0);
  }
}

TEST_CASE("Damaged masks hold back no message behind them", "[vectornav]") {
  VectornavDecoder decoder;
  VectornavCollector collector;
  for (std::size_t k = 0; k < 6; ++k) {
    Bytes one = increments(1.0F);
    // Two more groups with all fields that have a length: the next messages would be inside them.
    if (k == 2) one = {0xFA, 0x03, 0xFF, 0x7F, 0xFF, 0x03};
    decoder.feed(one, &collector);
    // Each message comes out with its own last byte.
    REQUIRE(collector.measurements.size() == (k < 2 ? k + 1 : k));
  }
  CHECK(decoder.counters().framer.bad_checksums == 1);
  CHECK(decoder.counters().framer.bytes_skipped == 6);
}

namespace {

// TimeStartup and DeltaTheta, 40 bytes of fields, in which a whole message with TimeStartup lies.
Bytes message_with_another_inside() {
  Bytes payload(20, 0);
  const Bytes inner = vectornav_message(0x01, {1 << 0}, Bytes(8, 7));
  payload.insert(payload.end(), inner.begin(), inner.end());
  payload.resize(36, 0);
  return vectornav_message(0x01, {1 << 0 | 1 << 11}, payload);
}

// The lengths of the messages that are found, byte by byte.
std::vector<std::size_t> found_lengths(VectornavFramer* framer, const Bytes& bytes) {
  std::vector<std::size_t> lengths;
  VectornavMessage found;
  for (const std::uint8_t byte : bytes) {
    REQUIRE(framer->append({&byte, 1}) == 1);
    while (framer->next(&found)) lengths.push_back(found.bytes.size());
  }
  return lengths;
}

}  // namespace

TEST_CASE("A message of a known kind is awaited before one that lies inside it", "[vectornav]") {
  VectornavFramer framer;
  const Bytes outer = message_with_another_inside();
  const Bytes same = vectornav_message(0x01, {1 << 0 | 1 << 11}, Bytes(36, 0));
  const Bytes other = vectornav_message(0x02, {1 << 0 | 1 << 1}, Bytes(16, 0));
  CHECK(found_lengths(&framer, same) == std::vector<std::size_t>{42});
  // Also where the sensor sends messages of another kind in between.
  CHECK(found_lengths(&framer, other) == std::vector<std::size_t>{22});
  CHECK(found_lengths(&framer, outer) == std::vector<std::size_t>{42});
  CHECK(framer.counters().bytes_skipped == 0);

  SECTION("a payload that is damaged loses nothing behind it") {
    Bytes stream = outer;
    stream.back() ^= 1U;
    stream.insert(stream.end(), same.begin(), same.end());
    const auto lengths = found_lengths(&framer, stream);
    REQUIRE(lengths.size() == 2);
    CHECK(lengths.front() == 14);  // by itself it is a message like any other
    CHECK(lengths.back() == 42);
  }
  SECTION("a message that is cut off holds nothing back") {
    Bytes stream(outer.begin(), outer.begin() + 10);
    stream.insert(stream.end(), same.begin(), same.end());
    CHECK(found_lengths(&framer, stream) == std::vector<std::size_t>{42});
  }
  SECTION("a damaged mask holds nothing back") {
    Bytes damaged = same;
    damaged[3] = 0x7F;  // claims fields of hundreds of bytes
    CHECK(found_lengths(&framer, damaged).empty());
    CHECK(found_lengths(&framer, same) == std::vector<std::size_t>{42});
  }
  SECTION("at the end of the stream a message inside a cut one comes out") {
    const Bytes cut(outer.begin(), outer.end() - 2);
    CHECK(found_lengths(&framer, cut).empty());
    framer.finish();
    VectornavMessage found;
    REQUIRE(framer.next(&found));
    CHECK(found.bytes.size() == 14);
  }
}

TEST_CASE("A header that is cut off holds back nothing, also at the end of the stream",
          "[vectornav]") {
  VectornavDecoder decoder;
  VectornavCollector collector;
  Bytes bytes = increments(1.0F);
  bytes.insert(bytes.end(), {0xFA, 0x7F, 0x01});
  decoder.feed(bytes, &collector);
  CHECK(collector.measurements.size() == 1);
  decoder.finish(&collector);
  CHECK(decoder.counters().framer.incomplete == 1);
  CHECK(decoder.counters().framer.bytes_skipped == 3);
}

TEST_CASE("The heave of the attitude group does not hide the increments", "[vectornav]") {
  Bytes payload;
  put(&payload, 42'000'000, 8);
  put_floats(&payload, {0.005F, 1.0F, 2.0F, -3.0F, 0.25F, -0.5F, -0.049F});
  put_floats(&payload, {0.1F, 0.2F, 0.3F});  // Heave: heave, its rate, the delayed heave
  const Bytes one = vectornav_message(0x11, {1 << 0 | 1 << 11, 1 << 12}, payload);
  const VectornavCollector found = decode_vectornav(one, 1);
  REQUIRE(found.measurements.size() == 1);
  CHECK(found.measurements[0].increments->delta_velocity_m_s[0] == 0.25);
}

TEST_CASE("Random bytes yield nothing and end", "[vectornav]") {
  std::mt19937 dice(2);
  Bytes stream(200'000);
  for (std::uint8_t& byte : stream)
    byte = dice() % 3 == 0 ? 0xFA : static_cast<std::uint8_t>(dice());
  VectornavCounters counters;
  const VectornavCollector found = decode_vectornav(stream, 4096, &counters);
  CHECK(found.measurements.size() < 3);  // a checksum of 16 bits is right by chance now and then
  CHECK(counters.framer.bytes_skipped > stream.size() - 4000);
}

}  // namespace leonav
