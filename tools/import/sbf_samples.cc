#include "tools/import/sbf_samples.h"

namespace leonav {
std::optional<ImuSample> SbfSamples::take(const ExtSensorRates& rates) {
  ImuReading reading;
  reading.gps_time = rates.time;
  reading.gyro = to_vector(rates.angular_rate_rad_s);
  reading.accel = to_vector(rates.specific_force_m_s2);
  return sampler_.sample(rates.time, reading);
}

}  // namespace leonav
