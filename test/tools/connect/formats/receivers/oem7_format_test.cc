// What leonav-connect publishes of a NovAtel stream, from messages packed here by the manual's
// tables.
#include "tools/connect/formats/receivers/oem7_format.h"

#include <cmath>
#include <variant>
#include <vector>

#include "published_inputs.h"
#include "support/catch.h"

namespace leonav {
namespace {

using test::Packed;
using test::PublishedInputs;

constexpr int kLogWeek = 2209;
constexpr std::uint32_t kLogTime_ms = 512'487'000;

std::vector<std::uint8_t> message(std::uint16_t id, std::uint32_t time_ms, const Packed& payload) {
  Packed all;
  all.add(0x1244AA, 3).add(28, 1).add(id, 2).add(0, 2).add(payload.bytes.size(), 2).add(0, 2);
  all.add(0, 1).add(180, 1).add(kLogWeek, 2).add(time_ms, 4).add(0, 8);
  all.bytes.insert(all.bytes.end(), payload.bytes.begin(), payload.bytes.end());
  std::uint32_t crc = 0;
  for (const std::uint8_t byte : all.bytes) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) crc = (crc & 1u) != 0 ? (crc >> 1) ^ 0xEDB88320u : crc >> 1;
  }
  return all.add(crc, 4).bytes;
}

// RANGE with GPS 5, L1 C/A.
std::vector<std::uint8_t> range(std::uint32_t time_ms) {
  Packed p;
  p.add(1, 4).add(5, 2).add(0, 2).real(2.2e7).single(0.1F).real(-1.1e8).single(0.01F);
  p.single(500.0F).single(45.0F).single(100.0F).add(4u | 7u << 10, 4);
  return message(43, time_ms, p);
}

std::vector<std::uint8_t> rawimux(int type, std::uint32_t time_ms) {
  Packed p;
  p.add(0, 1).add(static_cast<std::uint64_t>(type), 1).add(kLogWeek, 2).real(time_ms / 1000.0);
  p.add(0, 4).add(52'650'000, 4).add(static_cast<std::uint64_t>(-2000), 4).add(3000, 4);
  p.add(100, 4).add(static_cast<std::uint64_t>(-200), 4).add(300, 4);
  return message(1461, time_ms, p);
}

struct Oem7Rig {
  explicit Oem7Rig(const Oem7StreamOptions& options)
      : format(options, 0.05, 30.0, &clock, &output) {}
  PublishedInputs messages;
  MessageOutput output{&messages};
  GpsClock clock{TimeReference::kGnss, 0.05};
  Oem7Format format;
};

}  // namespace

TEST_CASE("An epoch is published with the last byte of its range log", "[connect]") {
  Oem7Rig rig({});
  const auto bytes = range(kLogTime_ms);
  rig.format.feed(std::span(bytes).first(bytes.size() - 1), 1);
  CHECK(rig.messages.epochs.empty());
  rig.format.feed(std::span(bytes).last(1), 2);
  REQUIRE(rig.messages.epochs.size() == 1);
  CHECK(rig.messages.epochs[0].observations.front().satellite == SatelliteId{System::kGps, 5});
  CHECK(rig.format.counts().messages == 1);
  CHECK(rig.format.detail() == "1 signals in the last epoch, 0 ephemerides");
}

TEST_CASE("Inertial samples are published where the configuration says so", "[connect]") {
  for (const bool is_inertial : {true, false}) {
    Oem7Rig rig({is_inertial, std::nullopt});
    rig.format.feed(range(kLogTime_ms), 1);
    for (std::uint32_t k = 0; k < 5; ++k) rig.format.feed(rawimux(58, kLogTime_ms + 10 * k), 1);
    CHECK(rig.format.counts().epochs == 1);  // samples do not stand for epochs
    // The first one's interval is not known.
    REQUIRE(rig.messages.samples.size() == (is_inertial ? 4 : 0));
    if (!is_inertial) {
      CHECK(rig.format.detail().ends_with("not published ('inertial: true' does)"));
      continue;
    }
    CHECK(rig.format.detail().ends_with("4 inertial samples"));
    const ImuSample& sample = rig.messages.samples.back();
    CHECK(sample.interval_ns == 10'000'000);
    CHECK(sample.time == GpsTime::from_week_and_tow(kLogWeek, kLogTime_ms / 1000.0 + 0.04));
    // HG4930: 2^-29 m/s and 2^-33 rad; the fields are up, backward, right.
    CHECK(sample.delta_velocity_b.z() == -52'650'000 * 0x1p-29);
    CHECK(sample.delta_velocity_b.x() == 2000 * 0x1p-29);
    CHECK(sample.delta_velocity_b.y() == 3000 * 0x1p-29);
    CHECK(sample.delta_theta_b == Eigen::Vector3d(200, 300, -100) * 0x1p-33);
    CHECK(rig.format.data_time()->nanoseconds == sample.time.nanoseconds());
  }
}

TEST_CASE("An IMU without a documented scale is told with its type and the remedy", "[connect]") {
  Oem7Rig rig({true, std::nullopt});
  for (std::uint32_t k = 0; k < 5; ++k) rig.format.feed(rawimux(49, kLogTime_ms + 10 * k), 1);
  CHECK(rig.messages.samples.empty());
  CHECK(rig.format.counts().refused == 5);
  for (const std::string& text : {rig.format.why_no_messages(), rig.format.detail()}) {
    CHECK(text.find("type 49") != std::string::npos);
    CHECK(text.find("imu_scale: [rad, m/s]") != std::string::npos);
  }
  Oem7Rig told({true, ImuScale{1e-9, 1e-9}});
  for (std::uint32_t k = 0; k < 5; ++k) told.format.feed(rawimux(49, kLogTime_ms + 10 * k), 1);
  CHECK(told.messages.samples.size() == 4);
}

TEST_CASE("Streams of text, or without range logs, are told", "[connect]") {
  Oem7Rig rig({});
  const std::string text = "#BESTPOSA,COM1,0,83.5,FINESTEERING,2209,512487.000*00000000\r\n";
  rig.format.feed(std::vector<std::uint8_t>(text.begin(), text.end()), 1);
  rig.format.finish();
  CHECK(rig.format.why_no_frames().find("end in B") != std::string::npos);
  Oem7Rig other({});
  other.format.feed(message(42, kLogTime_ms, Packed()), 1);
  CHECK(other.format.why_no_messages().find("BESTPOS") != std::string::npos);
  CHECK(other.format.why_no_messages().find("RANGECMPB") != std::string::npos);
}

}  // namespace leonav
