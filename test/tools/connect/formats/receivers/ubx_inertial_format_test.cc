// What leonav-connect makes of the inertial sensor of a u-blox receiver, and of pulses at its
// inputs, from messages put together here by the interface description's tables.
#include <bit>
#include <variant>
#include <vector>

#include "drivers/lcm/decode.h"
#include "support/bytes/ubx_message.h"
#include "support/catch.h"
#include "tools/connect/formats/receivers/ubx_format.h"

namespace leonav {
namespace {

using test::Bytes;
using test::message;
using test::put;
constexpr int kWeek = 2209;

// UBX-RXM-RAWX without a signal.
Bytes rawx(double tow_s) {
  Bytes payload;
  put(&payload, std::bit_cast<std::uint64_t>(tow_s), 8);
  put(&payload, kWeek, 2);
  put(&payload, 18, 1);
  put(&payload, 0, 1);
  put(&payload, 0, 1);
  put(&payload, 1, 1);
  put(&payload, 0, 2);
  return message(0x02, 0x15, payload);
}

// UBX-ESF-RAW with samples that end at `tick`: 1 degree/s about x, -9.75 m/s^2 along z.
Bytes raw(std::uint32_t tick, int samples) {
  Bytes payload(4, 0);
  for (int i = samples - 1; i >= 0; --i) {
    const std::pair<int, int> values[] = {{14, 4096}, {13, 0}, {5, 0},
                                          {16, 0},    {17, 0}, {18, -9984}};
    for (const auto& [type, value] : values) {
      put(&payload,
          static_cast<std::uint64_t>(type) << 24 | (static_cast<std::uint32_t>(value) & 0xFFFFFF),
          4);
      put(&payload, (tick - 256U * static_cast<unsigned>(i)) & 0xFFFFFF, 4);
    }
  }
  return message(0x10, 0x03, payload);
}

Bytes time_mark(int input, std::uint8_t edges, std::uint32_t tow_ms) {
  Bytes payload = {static_cast<std::uint8_t>(input), static_cast<std::uint8_t>(edges | 0x48), 1, 0};
  put(&payload, kWeek, 2);
  put(&payload, kWeek, 2);
  put(&payload, tow_ms, 4);
  put(&payload, 0, 4);
  put(&payload, tow_ms + 500, 4);
  put(&payload, 0, 4);
  put(&payload, 40, 4);
  return message(0x0D, 0x03, payload);
}

struct PublishedSamples : MessageTarget {
  void take(Channel channel, ByteSpan bytes) override {
    if (channel != Channel::kImu) return;
    REQUIRE(Decoder().decode(bytes, &samples.emplace_back()).fault == InputFault::kNone);
  }
  std::vector<ImuSample> samples;
};

struct UbxRig {
  explicit UbxRig(const UbxStreamOptions& options)
      : format(0.05, 30.0, &clock, &output, nullptr, options, &pulses) {}
  PublishedSamples messages;
  MessageOutput output{&messages};
  GpsClock clock{TimeReference::kGnss, 0.05};
  PulseQueue pulses;
  UbxFormat format;
};

}  // namespace

TEST_CASE("Samples of a receiver's own sensor are stamped by arrivals", "[connect]") {
  for (const bool is_inertial : {true, false}) {
    UbxRig rig({is_inertial, ImuStampOptions{0.01, 0.0}, {}});
    // Messages of ten samples each tenth of a second, 10 ms after the last of them; epochs after
    // 50 ms. The sensor's clock wraps on the way.
    for (std::int64_t tenth = 0; tenth < 200; ++tenth) {
      const std::int64_t now_ns = tenth * kNanosecondsPerSecond / 10;
      if (tenth % 10 == 0) {
        const double tow_s = 1000.0 + static_cast<double>(tenth) / 10.0;
        rig.format.feed(rawx(tow_s), now_ns + 50'000'000);
      }
      const auto tick = static_cast<std::uint32_t>(0xFFFFFF - 20'000 + 2560 * tenth);
      rig.format.feed(raw(tick, 10), now_ns + 10'000'000);
    }
    if (!is_inertial) {
      CHECK(rig.messages.samples.empty());
      CHECK_THAT(rig.format.detail(), Catch::Contains("'inertial: true' does"));
      continue;
    }
    REQUIRE(rig.messages.samples.size() > 1200);
    const ImuSample& last = rig.messages.samples.back();
    const GpsTime truth = GpsTime::from_week_and_tow(kWeek, 1019.9);
    CHECK(std::abs(nanoseconds_between(last.time, truth)) < 1'000'000);
    CHECK(last.interval_ns == 10'000'000);
    CHECK(last.delta_theta_b.x() == Approx(0.01 * 0.017453292519943295));
    CHECK(last.delta_velocity_b.z() == Approx(-0.0975));
    CHECK_THAT(rig.format.detail(), Catch::Contains("inertial samples, stamped by the sensor's"));
    CHECK(rig.format.stamp_sigma_s() < 1e-3);
    CHECK(rig.format.counts().refused == 0);
  }
}

TEST_CASE("Pulses of the configured input and edge are handed on", "[connect]") {
  UbxRig rig({false, {}, {1, true, 0.002}});
  rig.format.feed(time_mark(1, 0x84, 5000), 1);
  const auto mark = rig.pulses.pop();
  REQUIRE(mark);
  CHECK(mark->time == GpsTime::from_week_and_tow(kWeek, 5.5 - 0.002));
  CHECK(mark->sigma_s == Approx(40e-9));
  CHECK_THAT(rig.format.detail(), Catch::Contains("1 pulses"));
  UbxRig other({false, {}, {1, true, 0.0}});
  CHECK_THAT(other.format.detail(), Catch::Contains("switch UBX-TIM-TM2 on"));
  other.format.feed(time_mark(0, 0x84, 5000), 1);
  other.format.feed(time_mark(1, 0x80, 5000), 1);
  CHECK_FALSE(other.pulses.pop());
  CHECK_THAT(other.format.detail(), Catch::Contains("another input or with another edge"));
}

}  // namespace leonav
