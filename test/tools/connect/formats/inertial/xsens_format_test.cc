// What leonav-connect publishes of an Xsens stream, from messages put together here by the
// document's tables.
#include "tools/connect/formats/inertial/xsens_format.h"

#include <bit>
#include <numeric>
#include <vector>

#include "drivers/lcm/decode.h"
#include "support/catch.h"

namespace leonav {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Numbers one after the other, most significant byte first.
struct BigEndian {
  BigEndian& add(std::uint64_t value, int size) {
    for (int i = size - 1; i >= 0; --i) {
      bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
    return *this;
  }
  BigEndian& single(float value) { return add(std::bit_cast<std::uint32_t>(value), 4); }
  BigEndian& group(std::uint16_t identifier, int size) { return add(identifier, 2).add(size, 1); }
  BigEndian& vector(std::uint16_t identifier, float x, float y, float z) {
    return group(identifier, 12).single(x).single(y).single(z);
  }
  Bytes bytes;
};

Bytes message(std::uint8_t id, const BigEndian& payload) {
  Bytes bytes;
  for (const std::size_t byte :
       {std::size_t{0xFA}, std::size_t{0xFF}, std::size_t{id}, payload.bytes.size()})
    bytes.push_back(static_cast<std::uint8_t>(byte));
  for (const std::uint8_t byte : payload.bytes) bytes.push_back(byte);
  const unsigned sum = std::accumulate(bytes.begin() + 1, bytes.end(), 0U);
  bytes.push_back(static_cast<std::uint8_t>(256 - sum % 256));
  return bytes;
}

struct SamplesAlone : MessageTarget {
  void take(Channel channel, ByteSpan bytes) override {
    REQUIRE(channel == Channel::kImu);
    REQUIRE(Decoder().decode(bytes, &samples.emplace_back()).fault == InputFault::kNone);
  }
  std::vector<ImuSample> samples;
};

struct XsensRig {
  SamplesAlone messages;
  MessageOutput output{&messages};
  GpsClock clock{TimeReference::kHost, 0.0};
  XsensFormat format{&clock, ImuStampOptions{}, &output};
};

// 2021-05-13 12:05:37 UTC and some nanoseconds, with all flags.
BigEndian utc(std::uint32_t ns) {
  BigEndian p;
  p.group(0x1010, 12).add(ns, 4).add(2021, 2).add(5, 1).add(13, 1).add(12, 1).add(5, 1).add(37, 1);
  return p.add(7, 1);
}

}  // namespace

TEST_CASE("A sensor's axes become forward, right, down", "[connect]") {
  XsensRig rig;
  for (std::uint32_t k = 0; k < 3; ++k) {
    BigEndian p = utc(k * 10'000'000);
    p.vector(0x8020, 1.0F, 2.0F, 3.0F).vector(0x4020, 4.0F, 5.0F, 9.8125F);
    rig.format.feed(message(0x36, p), 1);
  }
  // The first one's interval is not known.
  REQUIRE(rig.messages.samples.size() == 2);
  const ImuSample& sample = rig.messages.samples[1];
  CHECK(sample.interval_ns == 10'000'000);
  CHECK(sample.delta_theta_b.isApprox(Eigen::Vector3d(0.01, -0.02, -0.03), 1e-15));
  CHECK(sample.delta_velocity_b.isApprox(Eigen::Vector3d(0.04, -0.05, -0.098125), 1e-15));
  // Thursday of week 2157, 18 s ahead of UTC.
  CHECK(sample.time ==
        GpsTime::from_week_and_tow(2157, 4 * 86400 + 12 * 3600 + 5 * 60 + 37 + 18 + 0.02));
  CHECK(rig.format.detail() == "stamped by the sensor's GPS time");
}

TEST_CASE("Increments come before rates, and cover one interval where a message was lost",
          "[connect]") {
  XsensRig rig;
  for (const std::uint32_t k : {0U, 1U, 2U, 4U, 5U}) {
    BigEndian p = utc(k * 10'000'000);
    p.vector(0x8020, 1.0F, 2.0F, 3.0F).vector(0x4020, 4.0F, 5.0F, 9.8F);
    p.group(0x8030, 16).single(1.0F).single(0.0F).single(0.0F).single(0.0F);
    p.vector(0x4010, 0.5F, 0.25F, 0.125F);
    rig.format.feed(message(0x36, p), 1);
  }
  REQUIRE(rig.messages.samples.size() == 4);
  for (const ImuSample& sample : rig.messages.samples) {
    CHECK(sample.interval_ns == 10'000'000);
    CHECK(sample.delta_velocity_b == Eigen::Vector3d(0.5, -0.25, -0.125));
    CHECK(sample.delta_theta_b == Eigen::Vector3d(0.0, 0.0, 0.0));
  }
}

TEST_CASE("Increments of different rates are left out, because motion would be missing",
          "[connect]") {
  XsensRig rig;
  std::uint32_t ms = 0;
  const auto feed = [&](bool has_turn) {
    BigEndian p = utc((ms += 1) * 1'000'000);
    p.vector(0x4010, 0.0F, 0.0F, 0.05F);
    if (has_turn) p.group(0x8030, 16).single(1.0F).single(0.0F).single(0.0F).single(0.0F);
    rig.format.feed(message(0x36, p), 1);
  };
  for (int k = 0; k < 60; ++k) feed(k % 2 == 0);
  CHECK(rig.messages.samples.empty());
  CHECK(rig.format.why_no_messages().find("give both the same rate") != std::string::npos);
  // 400 measurements later the rates are taken for equal.
  for (int k = 0; k < 390; ++k) feed(true);
  CHECK(rig.messages.samples.empty());
  for (int k = 0; k < 60; ++k) feed(true);
  CHECK(rig.messages.samples.size() > 20);
}

TEST_CASE("A time is asked for where the sensor gives none, and not where it does", "[connect]") {
  const bool has_time = GENERATE(true, false);
  XsensRig rig;
  BigEndian p;
  if (has_time) p.group(0x1060, 4).add(20'000, 4);  // SampleTimeFine
  p.vector(0x8020, 1.0F, 2.0F, 3.0F).vector(0x4020, 4.0F, 5.0F, 9.8F);
  rig.format.feed(message(0x36, p), 1);
  CHECK(rig.messages.samples.empty());
  CHECK((rig.format.why_no_messages().find("SampleTimeFine") == std::string::npos) == has_time);
}

TEST_CASE("The clock of the sensor goes on where it wraps", "[connect]") {
  XsensRig rig;
  std::uint32_t ticks = 0xFFFFFFFF - 40'000;  // it wraps after four seconds
  for (std::int64_t k = 0; k < 1000; ++k, ticks += 100) {
    BigEndian p;
    p.group(0x1060, 4).add(ticks, 4).vector(0x8020, 0, 0, 0).vector(0x4020, 0, 0, 9.8F);
    rig.format.feed(message(0x36, p), 1'700'000'000'000'000'000 + k * 10'000'000);
  }
  CHECK(rig.messages.samples.size() > 450);
  CHECK(rig.format.counts().refused == 0);
  CHECK_THAT(rig.format.detail(), Catch::Contains("0 steps"));
  for (const ImuSample& sample : rig.messages.samples) CHECK(sample.interval_ns == 10'000'000);
}

TEST_CASE("What an Xsens stream lacks is told with the remedy", "[connect]") {
  const auto problem = [](const Bytes& bytes) {
    XsensRig rig;
    rig.format.feed(bytes, 1);
    rig.format.finish();
    CHECK(rig.messages.samples.empty());
    return rig.format.why_no_messages();
  };
  BigEndian motion;
  motion.vector(0x8020, 0, 0, 0).vector(0x4020, 0, 0, 9.8F);
  BigEndian half;
  half.vector(0x8020, 0, 0, 0);
  BigEndian wild;
  wild.vector(0x8020, 0, 0, 1e9F).vector(0x4020, 0, 0, 9.8F);
  CHECK_THAT(problem(message(0x36, motion)), Catch::Contains("SampleTimeFine"));
  CHECK_THAT(problem(message(0x36, half)), Catch::Contains("add DeltaQ and DeltaV"));
  CHECK_THAT(problem(message(0x36, wild)), Catch::Contains("beyond what a sensor measures"));
  CHECK_THAT(problem(message(0x32, motion)), Catch::Contains("former output"));
  CHECK_THAT(problem(message(0x3E, BigEndian())), Catch::Contains("configuration state"));
  XsensRig rig;
  CHECK_THAT(rig.format.why_no_frames(), Catch::Contains("baud rate") && Catch::Contains("NMEA"));
  BigEndian clipped = utc(0);
  clipped.group(0xE020, 4).add(1 << 8, 4).vector(0x8020, 0, 0, 0).vector(0x4020, 0, 0, 9.8F);
  rig.format.feed(message(0x36, clipped), 1);
  CHECK_THAT(rig.format.detail(), Catch::Contains("1 samples at the end of the sensor's range"));
}

}  // namespace leonav
