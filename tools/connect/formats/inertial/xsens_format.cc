#include "tools/connect/formats/inertial/xsens_format.h"

#include <utility>

namespace leonav {
namespace {

constexpr std::int64_t kTick_ns = 100'000;  // of SampleTimeFine
constexpr int kUntilTrust = 400;            // so many measurements without an unpaired increment

Eigen::Vector3d forward_right_down(const XsensMeasurement::Vector& from) {
  return {from[0], -from[1], -from[2]};
}

}  // namespace

void XsensFormat::feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) {
  arrival_ns_ = arrival_ns;
  decoder_.feed(bytes, this);
}

bool XsensFormat::are_whole() {
  const std::uint64_t unpaired = decoder_.counters().unpaired;
  if (std::exchange(unpaired_, unpaired) != unpaired) {
    until_trust_ = kUntilTrust;
  } else if (until_trust_ > 0) {
    --until_trust_;
  }
  return until_trust_ == 0;
}

// Increments are exact where rates are samples, so they come first.
void XsensFormat::on_measurement(const XsensMeasurement& measurement) {
  const bool uses_increments = are_whole() && measurement.increments;
  if (!uses_increments && !measurement.rates) return;
  ImuReading reading;
  reading.arrival_ns = arrival_ns_;
  reading.gps_time = measurement.utc_time;
  if (measurement.sample_time_fine) {
    reading.clock_ns = sample_time_.extend(*measurement.sample_time_fine) * kTick_ns;
    reading.clock_step_s = static_cast<double>(kTick_ns) * 1e-9;
  }
  if (measurement.status) {
    reading.has_pulse = (*measurement.status & XsensMeasurement::kSyncOut) != 0;
  }
  if (uses_increments) {
    reading.are_increments = true;
    reading.gyro = forward_right_down(measurement.increments->delta_theta_rad);
    reading.accel = forward_right_down(measurement.increments->delta_velocity_m_s);
  } else {
    reading.gyro = forward_right_down(measurement.rates->angular_rate_rad_s);
    reading.accel = forward_right_down(measurement.rates->specific_force_m_s2);
  }
  take(reading);
}

FormatCounts XsensFormat::counts() const {
  const XsensCounters c = decoder_.counters();
  FormatCounts counts;
  counts.frames = c.framer.messages;
  counts.damaged =
      c.framer.bad_checksums + c.framer.bad_lengths + c.framer.bad_groups + c.framer.incomplete;
  counts.refused = c.bad_lengths + c.bad_values;
  add_to(&counts);
  return counts;
}

std::string XsensFormat::detail() const {
  const std::uint64_t clipped = decoder_.counters().clipped;
  return ImuFormat::detail() +
         (clipped > 0 ? "; " + std::to_string(clipped) + " samples at the end of the sensor's range"
                      : "");
}

std::string XsensFormat::why_no_frames() const {
  return "bytes arrive but no valid Xsens message: is the baud rate right, and is the output "
         "MTData2 and not NMEA?";
}

std::string XsensFormat::why_no_messages() const {
  const XsensCounters c = decoder_.counters();
  if (c.old_data > 0) {
    return "MTData arrives, the sensors' former output: set an output configuration, which makes "
           "it MTData2";
  }
  if (until_trust_ > 0 || (c.measurements == 0 && c.unpaired > 0)) {
    return "DeltaQ and DeltaV do not come in the same messages, so that motion would be missing: "
           "give both the same rate in the output configuration";
  }
  if (c.measurements == 0 && c.bad_values > 0)
    return "every value is beyond what a sensor measures";
  if (c.measurements == 0 && c.without_motion == 0) {
    return "messages arrive, but no MTData2: the sensor is in its configuration state "
           "(GoToMeasurement "
           "ends it)";
  }
  if (c.measurements == 0) {
    return "the messages hold no motion: add DeltaQ and DeltaV, or RateOfTurn and Acceleration, "
           "with one rate to the output configuration";
  }
  return why_no_samples_of("the output should hold SampleTimeFine");
}

}  // namespace leonav
