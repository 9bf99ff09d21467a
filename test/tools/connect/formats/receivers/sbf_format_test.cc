// What leonav-connect publishes of a Septentrio stream, from blocks packed here by the guide's
// tables.
#include "tools/connect/formats/receivers/sbf_format.h"

#include <vector>

#include "core/base/angle.h"
#include "published_inputs.h"
#include "support/catch.h"

namespace leonav {
namespace {

using test::Packed;
using test::PublishedInputs;

constexpr int kBlockWeek = 2367;
constexpr std::uint32_t kBlockTime_ms = 482'321'000;

std::vector<std::uint8_t> block(std::uint16_t number, std::uint32_t time_ms,
                                const Packed& payload) {
  Packed covered;
  const std::size_t size = (14 + payload.bytes.size() + 3) / 4 * 4;
  covered.add(number, 2).add(size, 2).add(time_ms, 4).add(kBlockWeek, 2);
  for (const std::uint8_t byte : payload.bytes) covered.add(byte, 1);
  while (covered.bytes.size() < size - 4) covered.add(0, 1);
  std::uint32_t crc = 0;
  for (const std::uint8_t byte : covered.bytes) {
    for (int i = 7; i >= 0; --i) {
      const std::uint32_t carry = ((crc >> 15) ^ (byte >> i)) & 1u;
      crc = ((crc << 1) & 0xFFFF) ^ (carry ? 0x1021u : 0u);
    }
  }
  Packed all;
  all.add('$', 1).add('@', 1).add(crc, 2);
  all.bytes.insert(all.bytes.end(), covered.bytes.begin(), covered.bytes.end());
  return all.bytes;
}

// One signal of G05.
std::vector<std::uint8_t> meas_epoch(std::uint32_t time_ms, unsigned flags = 0) {
  Packed p;
  p.add(1, 1).add(20, 1).add(12, 1).add(flags, 1).add(0, 2);
  p.add(1, 1).add(0, 1).add(5, 1).add(5, 1).add(500'000'000, 4).add(1'000'000, 4);
  p.add(100, 2).add(0, 1).add(160, 1).add(100, 2).add(0, 1).add(0, 1);
  return block(4027, time_ms, p);
}

std::vector<std::uint8_t> ext_sensor(std::uint32_t time_ms, bool has_rate = true) {
  Packed p;
  p.add(has_rate ? 2 : 1, 1).add(28, 1);
  p.add(0x20, 1).add(1, 1).add(0, 1).add(0, 1).real(0.5).real(-0.25).real(-9.8);
  if (has_rate) p.add(0x20, 1).add(1, 1).add(1, 1).add(0, 1).real(1.0).real(-2.0).real(3.0);
  return block(4050, time_ms, p);
}

struct SbfRig {
  explicit SbfRig(bool is_inertial) : format({is_inertial, false}, 0.05, 30.0, &clock, &output) {}
  PublishedInputs messages;
  MessageOutput output{&messages};
  GpsClock clock{TimeReference::kGnss, 0.05};
  SbfFormat format;
};

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("An epoch is published with the last byte of its MeasEpoch", "[connect]") {
  SbfRig rig(false);
  const auto bytes = meas_epoch(kBlockTime_ms);
  rig.format.feed(std::span(bytes).first(bytes.size() - 1), 1);
  CHECK(rig.messages.epochs.empty());
  rig.format.feed(std::span(bytes).last(1), 2);
  REQUIRE(rig.messages.epochs.size() == 1);
  CHECK(rig.messages.epochs[0].observations.front().satellite == SatelliteId{System::kGps, 5});
  CHECK(rig.format.counts().messages == 1);
  CHECK(rig.format.counts().frames == 1);
  CHECK(rig.format.detail() == "1 signals in the last epoch, 0 ephemerides");
}

TEST_CASE("Septentrio's inertial samples are published where the configuration says so",
          "[connect]") {
  for (const bool is_inertial : {true, false}) {
    SbfRig rig(is_inertial);
    rig.format.feed(meas_epoch(kBlockTime_ms), 1);
    for (std::uint32_t k = 0; k < 5; ++k) rig.format.feed(ext_sensor(kBlockTime_ms + 10 * k), 1);
    // The first one's interval is not known.
    REQUIRE(rig.messages.samples.size() == (is_inertial ? 4 : 0));
    if (!is_inertial) {
      CHECK(rig.format.detail().ends_with("not published ('inertial: true' does)"));
      continue;
    }
    CHECK(rig.format.detail().ends_with("4 inertial samples"));
    const ImuSample& sample = rig.messages.samples.back();
    CHECK(sample.interval_ns == 10'000'000);
    CHECK(sample.time == GpsTime::from_week_and_tow(kBlockWeek, kBlockTime_ms / 1000.0 + 0.04));
    CHECK((sample.delta_velocity_b - Eigen::Vector3d(0.5, -0.25, -9.8) * 0.01).norm() < 1e-15);
    CHECK((sample.delta_theta_b - Eigen::Vector3d(1, -2, 3) * kDegree * 0.01).norm() < 1e-15);
    CHECK(rig.format.data_time()->nanoseconds == sample.time.nanoseconds());
    CHECK(rig.format.counts().messages == 5);
  }
}

TEST_CASE("Septentrio streams that give nothing to publish are told with the remedy", "[connect]") {
  SbfRig text(false);
  const std::string nmea = "$GPGGA,135823.00,5324.0,N,00214.8,W,1,20,0.6,82.7,M,48.5,M,,*00\r\n";
  text.format.feed(std::vector<std::uint8_t>(nmea.begin(), nmea.end()), 1);
  text.format.finish();
  CHECK(contains(text.format.why_no_frames(), "setSBFOutput"));
  SbfRig positions(false);
  positions.format.feed(block(4007, kBlockTime_ms, Packed()), 1);
  CHECK(contains(positions.format.why_no_messages(), "PVTGeodetic"));
  CHECK(contains(positions.format.why_no_messages(), "turn on MeasEpoch"));
  SbfRig early(false);
  early.format.feed(meas_epoch(0xFFFFFFFF), 1);
  CHECK(contains(early.format.why_no_messages(), "no fix yet"));
  CHECK(early.format.counts().refused == 1);
  SbfRig scrambled(false);
  scrambled.format.feed(meas_epoch(kBlockTime_ms, 0x80), 1);
  CHECK(contains(scrambled.format.why_no_messages(), "permission"));
  CHECK(scrambled.messages.epochs.empty());
  SbfRig half(true);
  half.format.feed(ext_sensor(kBlockTime_ms, false), 1);
  CHECK(contains(half.format.detail(), "without both"));
  SbfRig silent(true);
  silent.format.feed(meas_epoch(kBlockTime_ms), 1);
  CHECK(contains(silent.format.detail(), "turn on ExtSensorMeas"));
}

}  // namespace leonav
