// Inertial readings and time marks of a u-blox receiver: against pyubx2, and put together here byte
// by byte.
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>

#include "drivers/ubx/oracle_program.h"
#include "drivers/ubx/walk_recording.h"
#include "support/bytes/ubx_message.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using test::Bytes;
using test::joined;
using test::message;
using test::put;

struct MarkCollector final : test::UbxCollector {
  void on_inertial(const EsfReading& reading) override { readings.push_back(reading); }
  void on_time_mark(const TimeMark& mark) override { marks.push_back(mark); }
  std::vector<EsfReading> readings;
  std::vector<TimeMark> marks;
};

MarkCollector decode_ubx(const Bytes& bytes, std::size_t chunk) {
  MarkCollector collector;
  UbxDecoder decoder;
  for (std::size_t i = 0; i < bytes.size(); i += chunk) {
    decoder.feed(std::span(bytes).subspan(i, std::min(chunk, bytes.size() - i)), &collector);
  }
  decoder.finish(&collector);
  collector.counters = decoder.counters();
  return collector;
}

std::uint64_t word(int type, int value) {
  return static_cast<std::uint64_t>(type) << 24 | (static_cast<std::uint32_t>(value) & 0xFFFFFF);
}

// One sample of UBX-ESF-RAW per tag: rates 1, -2, 3 degrees/s, forces 0.5, -0.5, -9.75 m/s^2.
Bytes raw(const std::vector<std::uint32_t>& tags, int left_out = 0) {
  Bytes payload(4, 0);
  for (const std::uint32_t tag : tags) {
    const std::pair<int, int> values[] = {{14, 4096}, {13, -8192}, {5, 12288}, {12, 2550},
                                          {16, 512},  {17, -512},  {18, -9984}};
    for (const auto& [type, value] : values) {
      if (type == left_out) continue;
      put(&payload, word(type, value), 4);
      put(&payload, tag, 4);
    }
  }
  return message(0x10, 0x03, payload);
}

Bytes time_mark(std::uint8_t flags, std::uint16_t week, std::uint32_t ms, std::uint32_t ns) {
  Bytes payload = {1, flags, 7, 0};
  put(&payload, week, 2);
  put(&payload, week, 2);
  put(&payload, ms, 4);
  put(&payload, ns, 4);
  put(&payload, ms + 1, 4);
  put(&payload, ns, 4);
  put(&payload, 25, 4);
  return message(0x0D, 0x03, payload);
}

constexpr std::uint8_t kRising = 0x80, kFalling = 0x04, kValid = 0x40, kUtcKnown = 0x20;
constexpr std::uint8_t kGnss = 1 << 3, kUtc = 2 << 3;

}  // namespace

TEST_CASE("Inertial values and pulses are what pyubx2 reads", "[ubx]") {
  if (!test::have_pyubx2()) return;
  const test::TemporaryFile stream("stream.ubx", ""), fields("fields.txt", "");
  REQUIRE(std::system(
              (test::ubx_oracle() + "generate 3 '" + stream.path() + "' >'" + fields.path() + "'")
                  .c_str()) == 0);
  const MarkCollector found = decode_ubx(test::read_bytes(stream.path()), 100);
  std::ifstream text(fields.path());
  std::size_t reading = 0, mark = 0;
  std::optional<std::int64_t> last_ns;
  for (std::string line; std::getline(text, line);) {
    std::istringstream split(line);
    const std::vector<std::string> words{std::istream_iterator<std::string>(split), {}};
    if (words[0] == "mark") {
      REQUIRE(mark < found.marks.size());
      const TimeMark& m = found.marks[mark++];
      const auto same = [](const std::optional<GpsTime>& time, const std::string& expected) {
        return time ? std::to_string(time->nanoseconds()) == expected : expected == "-";
      };
      CHECK(std::to_string(m.input) == words[1]);
      CHECK(std::to_string(m.rising_edges) == words[2]);
      CHECK(same(m.rising, words[3]));
      CHECK(same(m.falling, words[4]));
      CHECK(std::llround(m.accuracy_s * 1e9) == std::stoll(words[5]));
      continue;
    }
    REQUIRE(reading < found.readings.size());
    const EsfReading& r = found.readings[reading++];
    const bool is_raw = words[0] == "raw";
    CHECK((r.source == EsfReading::Source::kRaw) == is_raw);
    // Tags: milliseconds of 32 bits, ticks of 24 bits.
    const std::int64_t tag = std::stoll(words[1]);
    if (is_raw) {
      CHECK((r.clock_ns * 2 / 78125 & 0xFFFFFF) == tag);
    } else {
      CHECK((r.clock_ns / 1'000'000 & 0xFFFFFFFF) == tag);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(r.angular_rate_rad_s[i] ==
            Approx(std::stod(words[2 + i]) / 4096 * std::numbers::pi / 180).epsilon(1e-15));
      CHECK(r.specific_force_m_s2[i] == std::stod(words[5 + i]) / 1024);
    }
    REQUIRE(r.temperature_c.has_value() == (words[8] != "-"));
    if (r.temperature_c) CHECK(*r.temperature_c == Approx(std::stod(words[8]) / 100));
    // The clock goes on where its tag wraps. Calibrated tags, and those of the other message, are
    // clocks of their own.
    const bool follows = last_ns && reading != 301 && reading != 201;
    if (follows) CHECK(r.clock_ns - *last_ns == 10'000'000);
    last_ns = r.clock_ns;
  }
  CHECK(reading == found.readings.size());
  CHECK(reading > 350);
  CHECK(mark == found.marks.size());
  CHECK(mark == 75);
  CHECK(found.counters.esf.other_values == 60);
  CHECK(found.counters.esf.incomplete == 0);
}

TEST_CASE("Samples of one message know when it was sent", "[ubx]") {
  const MarkCollector found = decode_ubx(raw({1000, 1256, 1512}), 50);
  REQUIRE(found.readings.size() == 3);
  for (const EsfReading& r : found.readings) CHECK(r.sent_ns == found.readings[2].clock_ns);
  CHECK(found.readings[0].clock_ns == 39'062'500);
  CHECK(found.readings[1].clock_ns - found.readings[0].clock_ns == 10'000'000);
  CHECK(found.readings[0].angular_rate_rad_s[1] == Approx(-2.0 * std::numbers::pi / 180.0));
  CHECK(found.readings[0].specific_force_m_s2 == EsfReading::Vector{0.5, -0.5, -9.75});
  CHECK(found.readings[0].temperature_c == 25.5);
}

TEST_CASE("A missing axis costs its sample, a damaged message itself", "[ubx]") {
  const MarkCollector found = decode_ubx(joined({raw({0, 256}, 17), raw({512})}), 50);
  REQUIRE(found.readings.size() == 1);
  CHECK(found.readings[0].clock_ns == 20'000'000);
  CHECK(found.counters.esf.incomplete == 2);
  // Lengths that do not fit what they claim.
  Bytes odd(4 + 8 + 3, 0);
  const Bytes none;
  Bytes claims_three(8 + 4, 0);
  claims_three[5] = 3 << 3;
  Bytes claims_calibrated(8 + 4, 0);
  claims_calibrated[5] = 1 << 3;
  claims_calibrated[4] = 1 << 3;
  const MarkCollector damaged = decode_ubx(
      joined({message(0x10, 0x03, odd), message(0x10, 0x03, none), message(0x10, 0x02, none),
              message(0x10, 0x02, claims_three), message(0x10, 0x02, claims_calibrated)}),
      1);
  CHECK(damaged.readings.empty());
  CHECK(damaged.counters.esf.bad_length == 5);
}

TEST_CASE("Beside UBX-ESF-RAW the coarser UBX-ESF-MEAS is left out", "[ubx]") {
  Bytes payload = {1, 0, 0, 0, 0, 6 << 3, 0, 0};
  for (const int type : {14, 13, 5, 16, 17, 18}) put(&payload, word(type, 1), 4);
  const Bytes meas = message(0x10, 0x02, payload);
  const MarkCollector found = decode_ubx(joined({meas, raw({0}), meas, raw({256})}), 4096);
  CHECK(found.readings.size() == 3);
  CHECK(found.counters.esf.superseded == 1);
}

TEST_CASE("An edge has its time, or is counted by the reason why not", "[ubx]") {
  const auto one = [](const Bytes& bytes) { return decode_ubx(bytes, 4096); };
  const MarkCollector gnss = one(time_mark(kRising | kValid | kGnss, 2300, 1000, 250));
  REQUIRE(gnss.marks.size() == 1);
  CHECK(gnss.marks[0].input == 1);
  CHECK(gnss.marks[0].rising ==
        GpsTime::from_nanoseconds(2300 * kNanosecondsPerWeek + 1'000'000'250));
  CHECK_FALSE(gnss.marks[0].falling);
  CHECK(gnss.marks[0].accuracy_s == Approx(25e-9));
  // UTC is 18 s behind.
  const MarkCollector utc = one(time_mark(kFalling | kValid | kUtc | kUtcKnown, 2300, 1000, 0));
  REQUIRE(utc.marks.size() == 1);
  CHECK(utc.marks[0].falling ==
        GpsTime::from_nanoseconds(2300 * kNanosecondsPerWeek + 19'001'000'000));

  const auto counts = [&](const Bytes& bytes) { return one(bytes).counters.time_marks; };
  CHECK(counts(time_mark(kRising | kGnss, 2300, 0, 0)).without_time == 1);
  CHECK(counts(time_mark(kRising | kValid, 2300, 0, 0)).without_time == 1);
  CHECK(counts(time_mark(kRising | kValid | kUtc, 2300, 0, 0)).without_time == 1);
  CHECK(counts(time_mark(kValid | kGnss, 2300, 0, 0)).without_edge == 1);
  CHECK(counts(time_mark(kRising | kValid | kGnss, 0, 0, 0)).bad_time == 1);
  CHECK(counts(time_mark(kRising | kValid | kGnss, 2300, 604'800'000, 0)).bad_time == 1);
  CHECK(counts(time_mark(kRising | kValid | kGnss, 2300, 0, 1'000'000)).bad_time == 1);
  CHECK(counts(message(0x0D, 0x03, Bytes(27, 0))).bad_length == 1);
}

TEST_CASE("A false start holds no message back", "[ubx]") {
  // Claims 8000 bytes of RAWX; behind it come messages, a byte at a time.
  Bytes stream = {0xB5, 0x62, 0x02, 0x15, 0x40, 0x1F};
  std::vector<std::size_t> ends;
  for (std::uint32_t i = 0; i < 5; ++i) {
    const Bytes one = raw({256 * i});
    stream.insert(stream.end(), one.begin(), one.end());
    ends.push_back(stream.size());
    stream.insert(stream.end(), {0xB5, 0x62, 0x01, 0x07, 0x00, 0x18});  // another one
  }
  MarkCollector found;
  UbxDecoder decoder;
  std::vector<std::size_t> came;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    decoder.feed(std::span(stream).subspan(i, 1), &found);
    while (came.size() < found.readings.size()) came.push_back(i + 1);
  }
  CHECK(came == ends);
  decoder.finish(&found);
  CHECK(decoder.counters().framer.messages == 5);
  CHECK(decoder.counters().framer.bad_checksums == 5);
  CHECK(decoder.counters().framer.incomplete == 1);
  CHECK(decoder.counters().framer.bytes_skipped == 36);
}

TEST_CASE("Which message counts does not depend on the chunks that it comes in", "[ubx]") {
  // A whole message around another one: the inner one is whole first.
  const Bytes inner = raw({256});
  const Bytes outer = message(0x21, 0x04, inner);
  // Streams of starts alone, and of bytes that are often a start.
  Bytes starts, wild;
  unsigned state = 1;
  for (int i = 0; i < 20'000; ++i) {
    starts.insert(starts.end(), {0xB5, 0x62});
    state = state * 1664525U + 1013904223U;
    const unsigned kind = state >> 24 & 7;
    wild.push_back(kind < 2   ? 0xB5
                   : kind < 4 ? 0x62
                   : kind < 6 ? 0x00
                              : static_cast<std::uint8_t>(state >> 16));
  }
  const Bytes stream = joined({outer, starts, raw({512}), wild, outer, raw({768})});
  const MarkCollector whole = decode_ubx(stream, stream.size());
  CHECK(whole.readings.size() == 4);
  for (const std::size_t chunk : {1, 13, 4096}) {
    const MarkCollector parts = decode_ubx(stream, chunk);
    CHECK(parts.readings.size() == whole.readings.size());
    CHECK(parts.counters.framer.messages == whole.counters.framer.messages);
    CHECK(parts.counters.framer.bytes_skipped == whole.counters.framer.bytes_skipped);
    CHECK(parts.counters.framer.oversize == whole.counters.framer.oversize);
    CHECK(parts.counters.framer.bad_checksums == whole.counters.framer.bad_checksums);
  }
}

}  // namespace leonav
