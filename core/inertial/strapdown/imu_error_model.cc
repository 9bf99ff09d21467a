#include "core/inertial/strapdown/imu_error_model.h"

#include "core/base/angle.h"

#include <numbers>

namespace leonav {

ImuErrorModel consumer_mems_errors() {
  constexpr double kHour = 3600.0, kRootHour = 60.0;
  constexpr double kMilligal = 1e-5;
  ImuErrorModel imu;
  imu.angle_random_walk = 0.3 * (kDegree / kRootHour);
  imu.velocity_random_walk = 0.1 * (1.0 / kRootHour);
  imu.gyro_bias = {1000.0 * (kDegree / kHour), 1000.0};
  imu.accel_bias = {20000.0 * kMilligal, 1000.0};
  imu.gyro_scale = {5000.0 * 1e-6, 10000.0};
  imu.accel_scale = {5000.0 * 1e-6, 10000.0};
  return imu;
}

}  // namespace leonav
