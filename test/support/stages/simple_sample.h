// An IMU sample of a steady motion, right in all but what a test makes of its stamps.
#pragma once
#include <cstdint>

#include "core/inertial/strapdown/imu.h"

namespace leonav::test {

inline ImuSample sample_until(GpsTime time, std::int64_t interval_ns = 5'000'000) {
  ImuSample sample;
  sample.time = time;
  sample.interval_ns = interval_ns;
  const double dt = sample.interval_s();
  sample.delta_theta_b << 0.1 * dt, -0.2 * dt, 0.3 * dt;
  sample.delta_velocity_b << 0.5 * dt, 0.1 * dt, -9.8 * dt;
  return sample;
}

}  // namespace leonav::test
