// What leonav-connect publishes of an RTCM 3 stream, from messages encoded here by the standard's
// tables.
#include "tools/connect/formats/rtcm3_format.h"

#include <cmath>
#include <vector>

#include "core/base/calendar.h"
#include "drivers/binary/crc24q.h"
#include "drivers/lcm/decode.h"
#include "support/catch.h"

namespace leonav {
namespace {

// Bits, the most significant first.
class Bits {
 public:
  Bits& add(std::uint64_t value, int count) {
    for (int bit = count - 1; bit >= 0; --bit) bits_.push_back(value >> bit & 1U);
    return *this;
  }
  // With preamble, length and checksum.
  std::vector<std::uint8_t> frame() const {
    std::vector<std::uint8_t> bytes((bits_.size() + 7) / 8);
    for (std::size_t i = 0; i < bits_.size(); ++i)
      if (bits_[i] != 0) bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | 0x80U >> i % 8);
    bytes.insert(bytes.begin(), {0xD3, static_cast<std::uint8_t>(bytes.size() >> 8),
                                 static_cast<std::uint8_t>(bytes.size() & 0xFFU)});
    std::uint32_t crc = 0;
    for (const std::uint8_t byte : bytes) crc = crc24q_next(crc, byte);
    for (const int shift : {16, 8, 0})
      bytes.push_back(static_cast<std::uint8_t>(crc >> shift & 0xFFU));
    return bytes;
  }

 private:
  std::vector<std::uint64_t> bits_;
};

// MSM4 of satellite 7 with one signal, whose mask is 1 << (32 - 2) for L1 C/A: 75 ms and a half.
std::vector<std::uint8_t> msm4(int number, std::uint64_t time_ms) {
  Bits bits;
  bits.add(static_cast<std::uint64_t>(number), 12).add(1, 12).add(time_ms, 30).add(0, 1);
  bits.add(0, 3).add(0, 7).add(0, 2).add(0, 2).add(0, 1).add(0, 3);
  bits.add(std::uint64_t{1} << (64 - 7), 64).add(std::uint64_t{1} << (32 - 2), 32).add(1, 1);
  bits.add(75, 8).add(512, 10);
  bits.add(0, 15).add(0, 22).add(5, 4).add(0, 1).add(45, 6);
  return bits.frame();
}

struct Epochs : MessageTarget {
  void take(Channel channel, ByteSpan bytes) override {
    REQUIRE(channel == Channel::kGnssEpoch);
    RawEpoch epoch;
    REQUIRE(Decoder().decode(bytes, &epoch).fault == InputFault::kNone);
    list.push_back(epoch);
  }
  std::vector<RawEpoch> list;
};

// Of 2024-03-20, a Wednesday: 04:00 GPS time.
const GpsTime kTime = from_calendar({2024, 3, 20, 4, 0, 0.0});
constexpr std::uint64_t kOfWeek_ms = (3 * 24 + 4) * 3'600'000ULL;

std::int64_t host_ns(GpsTime time) {
  return time.nanoseconds() + (315'964'800 - leap_seconds(time)) * kNanosecondsPerSecond;
}

}  // namespace

TEST_CASE("Observations are published with the week of the host's clock, or of the day told",
          "[connect]") {
  const bool is_live = GENERATE(true, false);
  Epochs epochs;
  MessageOutput output(&epochs);
  GpsClock clock(TimeReference::kGnss, 0.05);
  Rtcm3Format format(is_live ? GpsTime() : kTime.plus_seconds(-2.5 * 86'400), 30.0, &clock,
                     &output);
  for (int second = 0; second < 3; ++second) {
    const auto bytes = msm4(1074, kOfWeek_ms + 1000U * static_cast<unsigned>(second));
    // A file is read at any time.
    const GpsTime now = is_live ? kTime.plus_seconds(second + 0.1) : kTime.plus_seconds(9e6);
    format.feed(bytes, host_ns(now));
  }
  format.finish();
  REQUIRE(epochs.list.size() == 3);
  CHECK(epochs.list[2].time == kTime.plus_seconds(2.0));
  REQUIRE(epochs.list[2].observations.size() == 1);
  const SignalObservation& observation = epochs.list[2].observations.front();
  CHECK(observation.satellite == SatelliteId{System::kGps, 7});
  CHECK(observation.pseudorange_m == Approx(0.0755 * 299'792'458.0).epsilon(1e-12));
  CHECK(format.counts().frames == 3);
  CHECK(format.counts().messages == 3);
  CHECK(format.counts().damaged == 0);
  CHECK(format.data_time()->nanoseconds == kTime.plus_seconds(2.0).nanoseconds());
  CHECK(format.detail() == "1 signals in the last epoch, 0 ephemerides");
}

TEST_CASE("A stream without what is needed is told with what it has", "[connect]") {
  Epochs epochs;
  MessageOutput output(&epochs);
  GpsClock clock(TimeReference::kGnss, 0.05);
  Rtcm3Format format(kTime, 30.0, &clock, &output);
  std::vector<std::uint8_t> damaged = msm4(1074, kOfWeek_ms);
  damaged[10] ^= 0x10U;
  format.feed(damaged, host_ns(kTime));
  format.feed(msm4(1084, 3'600'000), host_ns(kTime));
  format.finish();
  CHECK(epochs.list.empty());
  CHECK(format.counts().damaged == 1);
  CHECK(format.counts().frames == 1);
  CHECK(format.why_no_messages().find("1084") != std::string::npos);
  CHECK(format.why_no_messages().find("MSM4 to MSM7") != std::string::npos);
}

}  // namespace leonav
