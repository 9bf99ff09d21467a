#include "tools/import/oem7_samples.h"

#include <string>

namespace leonav {
std::optional<ImuSample> Oem7Samples::take(const RawImuIncrements& increments) {
  ImuReading reading;
  reading.gps_time = increments.time;
  reading.are_increments = true;
  reading.gyro = to_vector(increments.delta_theta_rad);
  reading.accel = to_vector(increments.delta_velocity_m_s);
  return sampler_.sample(increments.time, reading);
}

std::string problem_of_scale(const RawImuCounters& counters) {
  if (counters.samples > 0 || counters.unknown_scale == 0) return "";
  const std::string remedy =
      "give what a count stands for as 'imu_scale: [rad, m/s]', from the manual of the sensor";
  if (!counters.type_without_scale) {
    return "RAWIMU and RAWIMUS do not say which IMU it is: log RAWIMUSXB instead, or INSCONFIGB "
           "once, or " +
           remedy;
  }
  return "no scale is known of an IMU of type " + std::to_string(*counters.type_without_scale) +
         ": " + remedy;
}

}  // namespace leonav
