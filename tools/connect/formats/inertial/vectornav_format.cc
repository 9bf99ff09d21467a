#include "tools/connect/formats/inertial/vectornav_format.h"

#include <algorithm>

namespace leonav {
void VectornavFormat::feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) {
  arrival_ns_ = arrival_ns;
  bytes_ += bytes.size();
  text_bytes_ +=
      static_cast<std::uint64_t>(std::count_if(bytes.begin(), bytes.end(), [](std::uint8_t byte) {
        return (byte >= ' ' && byte <= '~') || byte == '\r' || byte == '\n';
      }));
  decoder_.feed(bytes, this);
}

// Increments are exact where rates are samples, so they come first. A UTC time, to its millisecond,
// serves where there is no other.
void VectornavFormat::on_measurement(const VectornavMeasurement& measurement) {
  ImuReading reading;
  reading.arrival_ns = arrival_ns_;
  reading.gps_time = measurement.gps_time ? measurement.gps_time : measurement.utc_time;
  if (measurement.startup_ns && *measurement.startup_ns < std::uint64_t{1} << 62) {
    reading.clock_ns = static_cast<std::int64_t>(*measurement.startup_ns);
  }
  if (measurement.increments) {
    reading.are_increments = true;
    reading.interval_s = measurement.increments->interval_s;
    reading.gyro = to_vector(measurement.increments->delta_theta_rad);
    reading.accel = to_vector(measurement.increments->delta_velocity_m_s);
  } else {
    reading.gyro = to_vector(measurement.rates->angular_rate_rad_s);
    reading.accel = to_vector(measurement.rates->specific_force_m_s2);
  }
  take(reading);
}

FormatCounts VectornavFormat::counts() const {
  const VectornavCounters c = decoder_.counters();
  FormatCounts counts;
  counts.frames = c.framer.messages;
  counts.damaged = c.framer.bad_checksums + c.framer.unknown_fields + c.framer.incomplete;
  counts.refused = c.bad_values;
  add_to(&counts);
  return counts;
}

std::string VectornavFormat::why_no_frames() const {
  if (text_bytes_ * 10 > bytes_ * 9) {
    return "text arrives, but no binary message: switch a binary output on (register 75), and the "
           "asynchronous text output off (register 6)";
  }
  return "bytes arrive but no valid binary message: is the baud rate right, and has the output no "
         "field of the GNSS groups' SatInfo and RawMeas?";
}

std::string VectornavFormat::why_no_messages() const {
  const VectornavCounters c = decoder_.counters();
  if (c.measurements == 0 && c.bad_values > 0)
    return "every value is beyond what a sensor measures";
  if (c.measurements == 0) {
    return "the messages hold no motion: add DeltaTheta of the common group, or AngularRate and "
           "Accel of the IMU group, to the binary output";
  }
  return why_no_samples_of(
      "the output should hold TimeGps, or at least TimeStartup, of the common group");
}

}  // namespace leonav
