// Xsens messages, whole and damaged. The oracle of every field is the encoder in Python, which was
// written from the protocol document; messages of one kind are put together here byte by byte.
#include "drivers/xsens/xsens_decoder.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <numeric>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/calendar.h"
#include "drivers/binary/wrapped_counter.h"
#include "support/bytes/bytes.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using test::Bytes;
using test::joined;

class XsensCollector : public XsensHandler {
 public:
  void on_measurement(const XsensMeasurement& measurement) override {
    measurements.push_back(measurement);
  }
  std::vector<XsensMeasurement> measurements;
};

// Of the document: all bytes but the preamble, with the checksum, add up to a multiple of 256.
Bytes xsens_message(std::uint8_t id, const Bytes& payload) {
  Bytes bytes = {0xFA, 0xFF, id, static_cast<std::uint8_t>(payload.size())};
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  const unsigned sum = std::accumulate(bytes.begin() + 1, bytes.end(), 0U);
  bytes.push_back(static_cast<std::uint8_t>(256 - sum % 256));
  return bytes;
}

// Groups of single precision: 1.0 is 3F 80 00 00, 0.5 is 3F 00 00 00, -2.0 is C0 00 00 00.
const Bytes kVector = {0x3F, 0x80, 0, 0, 0x3F, 0, 0, 0, 0xC0, 0, 0, 0};
const Bytes kRate = joined({{0x80, 0x20, 12}, kVector});
const Bytes kForce = joined({{0x40, 0x20, 12}, kVector});
const Bytes kDeltaV = joined({{0x40, 0x10, 12}, kVector});
const Bytes kNoTurn = {0x80, 0x30, 16, 0x3F, 0x80, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};

// Rates, and a packet counter to tell messages by.
Bytes marked(unsigned mark) {
  return xsens_message(0x36, joined({{0x10, 0x20, 2, static_cast<std::uint8_t>(mark >> 8 & 255),
                                      static_cast<std::uint8_t>(mark & 255)},
                                     kRate,
                                     kForce}));
}

XsensCollector decode_xsens(const Bytes& bytes, std::size_t chunk,
                            XsensCounters* counters = nullptr) {
  XsensDecoder decoder;
  XsensCollector collector;
  for (std::size_t i = 0; i < bytes.size(); i += chunk) {
    decoder.feed(std::span(bytes).subspan(i, std::min(chunk, bytes.size() - i)), &collector);
  }
  decoder.finish(&collector);
  if (counters != nullptr) *counters = decoder.counters();
  return collector;
}

}  // namespace

TEST_CASE("Every field in every precision is what the encoder put there", "[xsens]") {
  if (std::system("command -v python3 >/dev/null") != 0) {
    std::cout << "SKIPPED: no python3\n";
    return;
  }
  const test::TemporaryFile stream("stream.bin", ""), fields("fields.txt", "");
  REQUIRE(std::system(("python3 '" LEONAV_SOURCE_DIR "/test/oracle/xsens.py' generate 7 '" +
                       stream.path() + "' >'" + fields.path() + "'")
                          .c_str()) == 0);
  std::ifstream file(stream.path(), std::ios::binary);
  const Bytes bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  XsensCounters counters;
  const auto found = decode_xsens(bytes, 1000, &counters).measurements;
  CHECK(counters.framer.bytes_skipped == 0);
  CHECK(counters.bad_lengths == 0);
  CHECK(counters.bad_values == 0);
  CHECK(counters.other_messages > 100);
  CHECK(counters.without_motion > 500);

  std::ifstream text(fields.path());
  std::size_t next = 0, rotations = 0, times = 0;
  for (std::string line; std::getline(text, line); ++next) {
    REQUIRE(next < found.size());
    const XsensMeasurement& m = found[next];
    std::istringstream stream_of_words(line);
    const std::vector<std::string> words{std::istream_iterator<std::string>(stream_of_words), {}};
    REQUIRE(words.size() == 19);
    const auto same = [&words](std::size_t place, const auto& value) {
      return value ? words[place] == std::to_string(*value) : words[place] == "-";
    };
    CHECK(same(1, m.sample_time_fine));
    CHECK(same(2, m.sample_time_coarse));
    CHECK(same(3, m.packet_counter));
    CHECK(same(4, m.status));
    REQUIRE(m.utc_time.has_value() == (words[0] != "-"));
    if (m.utc_time) {
      ++times;
      // GPS time began 315964800 s after 1970, and is ahead of UTC by the leap seconds.
      CHECK(m.utc_time->nanoseconds() - leap_seconds(*m.utc_time) * kNanosecondsPerSecond +
                315'964'800 * kNanosecondsPerSecond ==
            std::stoll(words[0]));
    }
    REQUIRE(m.temperature_c.has_value() == (words[5] != "-"));
    if (m.temperature_c) CHECK(*m.temperature_c == std::stod(words[5]));
    REQUIRE(m.increments.has_value() == (words[6] != "-"));
    REQUIRE(m.rates.has_value() == (words[13] != "-"));
    for (std::size_t i = 0; i < 3; ++i) {
      if (m.increments) {
        const double error = std::abs(m.increments->delta_theta_rad[i] - std::stod(words[6 + i]));
        CHECK(error <= std::stod(words[9]));
        CHECK(m.increments->delta_velocity_m_s[i] == std::stod(words[10 + i]));
        ++rotations;
      }
      if (m.rates) {
        CHECK(m.rates->angular_rate_rad_s[i] == std::stod(words[13 + i]));
        CHECK(m.rates->specific_force_m_s2[i] == std::stod(words[16 + i]));
      }
    }
  }
  CHECK(next == found.size());
  CHECK(rotations > 2000);
  CHECK(times > 200);
}

TEST_CASE("A rotation vector has the angle and the axis of its quaternion", "[xsens]") {
  // A quarter turn about z: (cos 45, 0, 0, sin 45) degrees; 0x3F3504F3 is the square root of 1/2.
  const Bytes quarter = {0x80, 0x30, 16, 0x3F, 0x35, 0x04, 0xF3, 0,    0,   0,
                         0,    0,    0,  0,    0,    0x3F, 0x35, 0x04, 0xF3};
  const auto found = decode_xsens(xsens_message(0x36, joined({quarter, kDeltaV})), 5).measurements;
  REQUIRE(found.size() == 1);
  REQUIRE(found[0].increments);
  CHECK(found[0].increments->delta_theta_rad[2] == Approx(1.5707963267948966).epsilon(1e-7));
  CHECK(found[0].increments->delta_theta_rad[0] == 0.0);
  CHECK(found[0].increments->delta_velocity_m_s[2] == -2.0);
  // No turn at all.
  const auto still = decode_xsens(xsens_message(0x36, joined({kNoTurn, kDeltaV})), 5).measurements;
  REQUIRE(still.size() == 1);
  CHECK(still[0].increments->delta_theta_rad == XsensMeasurement::Vector{0.0, 0.0, 0.0});
}

TEST_CASE("Values beyond any sensor and groups of a wrong length are counted and left out",
          "[xsens]") {
  XsensCounters counters;
  // 1.0, 0.5, NaN.
  const Bytes wild = {0x80, 0x20, 12, 0x3F, 0x80, 0, 0, 0x3F, 0, 0, 0, 0x7F, 0xC0, 0, 0};
  CHECK(decode_xsens(xsens_message(0x36, joined({wild, kForce})), 64, &counters)
            .measurements.empty());
  CHECK(counters.bad_values == 1);
  // A quaternion of length two.
  Bytes long_turn = kNoTurn;
  long_turn[3] = 0x40;
  long_turn[4] = 0;
  CHECK(decode_xsens(xsens_message(0x36, joined({long_turn, kDeltaV})), 64, &counters)
            .measurements.empty());
  CHECK(counters.bad_values == 1);
  // Bad increments beside good rates cost themselves alone.
  const auto both =
      decode_xsens(xsens_message(0x36, joined({long_turn, kDeltaV, kRate, kForce})), 64, &counters);
  REQUIRE(both.measurements.size() == 1);
  CHECK_FALSE(both.measurements[0].increments);
  CHECK(both.measurements[0].rates);
  // SampleTimeFine of three bytes, a rate of two numbers.
  const Bytes short_time = {0x10, 0x60, 3, 1, 2, 3};
  const auto without_time =
      decode_xsens(xsens_message(0x36, joined({short_time, kRate, kForce})), 9, &counters);
  REQUIRE(without_time.measurements.size() == 1);
  CHECK_FALSE(without_time.measurements[0].sample_time_fine);
  CHECK(counters.bad_lengths == 1);
  const Bytes short_rate = {0x80, 0x20, 8, 0, 0, 0, 0, 0, 0, 0, 0};
  CHECK(decode_xsens(xsens_message(0x36, joined({short_rate, kForce})), 9, &counters)
            .measurements.empty());
  CHECK(counters.bad_lengths == 1);
  CHECK(counters.without_motion == 1);
  CHECK(counters.unpaired == 0);
  decode_xsens(xsens_message(0x36, joined({kDeltaV, kRate, kForce})), 9, &counters);
  CHECK(counters.unpaired == 1);
}

TEST_CASE("A sensor at the end of its range says so in the status word", "[xsens]") {
  XsensCounters counters;
  const auto status = [](std::uint8_t high, std::uint8_t low) {
    return Bytes{0xE0, 0x20, 4, 0, high, low, 0x03};
  };
  const auto with = [&](const Bytes& word) {
    return decode_xsens(xsens_message(0x36, joined({word, kRate, kForce})), 64, &counters)
        .measurements.at(0);
  };
  CHECK_FALSE(with(status(0, 0)).is_clipped());
  CHECK(with(status(0, 0x01)).is_clipped());        // acceleration, x
  CHECK(with(status(0, 0x20)).is_clipped());        // rate, z
  CHECK_FALSE(with(status(0, 0x40)).is_clipped());  // the magnetometer does not matter
  CHECK((*with(status(0x40, 0)).status & XsensMeasurement::kSyncOut) != 0);
  CHECK(counters.clipped == 0);
  with(status(0, 0x08));
  CHECK(counters.clipped == 1);
}

TEST_CASE("A counter that wraps goes on", "[xsens]") {
  WrappedCounter counter(32);
  CHECK(counter.extend(0xFFFFFFF0) == 0xFFFFFFF0);
  CHECK(counter.extend(0x00000010) == 0x100000010);
  CHECK(counter.extend(0xFFFFFFFF) == 0xFFFFFFFF);
  CHECK(counter.extend(0x00000000) == 0x100000000);
  WrappedCounter day(24);
  std::int64_t truth = 5;
  CHECK(day.extend(5) == truth);
  for (int i = 0; i < 100; ++i) {
    truth += 8'000'000;  // less than half of the range
    CHECK(day.extend(static_cast<std::uint32_t>(truth & 0xFFFFFF) | 0xAB000000) == truth);
  }
  // Back by less than half of the range, below zero too.
  WrappedCounter back(8);
  CHECK(back.extend(3) == 3);
  CHECK(back.extend(250) == -6);
  CHECK(back.extend(0) == 0);
}

TEST_CASE("Damage of MTData2 costs the message that it is in and no other, in chunks of any size",
          "[xsens]") {
  constexpr std::size_t kMessages = 400;
  Bytes stream;
  std::vector<bool> is_damaged(kMessages, false);
  std::mt19937 dice(1);
  for (std::size_t i = 0; i < kMessages; ++i) {
    Bytes one = marked(static_cast<unsigned>(i));
    if (dice() % 4 == 0) {
      one[dice() % one.size()] ^= static_cast<std::uint8_t>(1U << dice() % 8);
      is_damaged[i] = true;
    }
    // False starts, one of which claims the longest message, and bytes of nobody.
    if (dice() % 5 == 0) stream.insert(stream.end(), {0xFA, 0xFF, 0x36, 0xFF, 0x08, 0x00});
    if (dice() % 5 == 0) stream.insert(stream.end(), {0xFA, 0xFF, 0x36, 0xFF, 0xFF, 0xFA});
    if (dice() % 5 == 0) stream.insert(stream.end(), {0xFA, 0x01, 0x00, 0xFA});
    stream.insert(stream.end(), one.begin(), one.end());
  }
  for (const std::size_t chunk : {1, 13, 4096}) {
    XsensCounters counters;
    const XsensCollector found = decode_xsens(stream, chunk, &counters);
    std::size_t next = 0, expected = 0;
    for (std::size_t i = 0; i < kMessages; ++i) {
      if (is_damaged[i]) continue;
      ++expected;
      REQUIRE(next < found.measurements.size());
      CHECK(found.measurements[next++].packet_counter == i);
    }
    CHECK(found.measurements.size() == expected);
    CHECK(counters.framer.messages == expected);
    CHECK(counters.framer.bad_checksums > 0);
    CHECK(counters.framer.bad_lengths > 0);
  }
}

TEST_CASE("A good checksum alone makes no message: the groups must fill it", "[xsens]") {
  // A message whose group claims one byte more than there is, around a whole one.
  const Bytes inner = marked(5);
  Bytes payload = {0xC0, 0x20, static_cast<std::uint8_t>(inner.size() + 1)};
  payload.insert(payload.end(), inner.begin(), inner.end());
  XsensCounters counters;
  const auto found = decode_xsens(xsens_message(0x36, payload), 4096, &counters).measurements;
  CHECK(counters.framer.bad_checksums == 1);
  REQUIRE(found.size() == 1);
  CHECK(found[0].packet_counter == 5);
  payload.back() = 0, payload[7] = 0;  // the one inside is none now
  CHECK(decode_xsens(xsens_message(0x36, payload), 4096, &counters).measurements.empty());
  CHECK(counters.framer.bad_groups == 1);
}

TEST_CASE("A damaged length holds back no message behind it, nor does a false start", "[xsens]") {
  for (const bool is_long : {true, false}) {
    Bytes damaged = marked(1);
    damaged[3] = is_long ? 0xFF : 250;
    if (is_long) damaged[4] = 0x07, damaged[5] = 0xD0;  // 2000 bytes
    const Bytes stream = joined({marked(0), damaged, {0xFA, 0xFF}, marked(2)});
    XsensDecoder decoder;
    XsensCollector collector;
    for (const std::uint8_t byte : stream) decoder.feed(std::span(&byte, 1), &collector);
    REQUIRE(collector.measurements.size() == 2);  // before the end of the stream
    CHECK(collector.measurements[1].packet_counter == 2);
    CHECK(decoder.counters().framer.bytes_skipped == damaged.size() + 2);
  }
  // Other messages have no groups: they wait until an earlier start is known to be none.
  XsensDecoder decoder;
  XsensCollector collector;
  Bytes inner = joined({{0x10, 0x20, 2, 0, 9}, kRate, kForce, {0xC0, 0x20, 0}});
  const Bytes other = xsens_message(0x3E, {});
  inner.back() = static_cast<std::uint8_t>(other.size());
  inner.insert(inner.end(), other.begin(), other.end());
  for (const std::uint8_t byte : xsens_message(0x36, inner)) {
    decoder.feed(std::span(&byte, 1), &collector);
  }
  REQUIRE(collector.measurements.size() == 1);
  CHECK(collector.measurements[0].packet_counter == 9);
}

TEST_CASE("Random bytes yield no measurement and end", "[xsens]") {
  std::mt19937 dice(2);
  Bytes stream(200'000);
  for (std::uint8_t& byte : stream) {
    const auto kind = dice() % 8;
    byte = kind == 0   ? 0xFA
           : kind == 1 ? 0xFF
           : kind == 2 ? 0x36
                       : static_cast<std::uint8_t>(dice());
  }
  XsensCounters counters;
  const XsensCollector found = decode_xsens(stream, 4096, &counters);
  CHECK(found.measurements.empty());
  CHECK(counters.framer.bad_checksums > 100);
  CHECK(counters.framer.bad_groups > 0);
}

}  // namespace leonav
