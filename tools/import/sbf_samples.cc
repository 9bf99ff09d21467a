#include "tools/import/sbf_samples.h"

namespace leonav {
namespace {

Eigen::Vector3d vector(const ExtSensorRates::Vector& from) { return {from[0], from[1], from[2]}; }

}  // namespace

std::optional<ImuSample> SbfSamples::take(const ExtSensorRates& rates) {
  ImuReading reading;
  reading.gps_time = rates.time;
  reading.gyro = vector(rates.angular_rate_rad_s);
  reading.accel = vector(rates.specific_force_m_s2);
  return sampler_.sample(rates.time, reading);
}

}  // namespace leonav
