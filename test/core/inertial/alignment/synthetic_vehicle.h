// A vehicle on a plane with the IMU of its grade: speeds and bends as told, forward or in reverse.
#pragma once
#include <cmath>
#include <random>

#include "core/base/angle.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/inertial/strapdown/imu.h"
#include "core/inertial/strapdown/imu_error_model.h"

namespace leonav::test {

inline ImuErrorModel tactical_imu() {
  ImuErrorModel imu;
  imu.angle_random_walk = 0.05 * kDegree / 60.0;
  imu.velocity_random_walk = 0.1 / 60.0;
  imu.gyro_bias = {0.5 * kDegree / 3600.0, 3600.0};
  imu.accel_bias = {25e-5, 3600.0};
  return imu;
}

inline ImuErrorModel mems_imu() {
  ImuErrorModel imu = tactical_imu();
  imu.angle_random_walk = 0.3 * kDegree / 60.0;
  imu.gyro_bias = {1000.0 * kDegree / 3600.0, 1000.0};
  imu.accel_bias = {0.2, 1000.0};
  return imu;
}

class SyntheticVehicle {
 public:
  static constexpr double kDt = 0.01;

  SyntheticVehicle(const ImuErrorModel& imu, double yaw, std::uint64_t seed)
      : imu_(imu), bits_(seed), yaw_(yaw) {
    gyro_bias_b_ = imu.gyro_bias.sigma * three();
    accel_bias_b_ = imu.accel_bias.sigma * three();
  }

  // One sample of changing the speed along the body's x axis (negative: in reverse), in a bend.
  ImuSample step(double acceleration, double curvature) {
    const double middle = speed_ + 0.5 * acceleration * kDt;
    const double rate = middle * curvature;
    const Eigen::Vector3d force_b(acceleration, middle * rate, -9.81);
    speed_ += acceleration * kDt;
    const Eigen::Vector3d earth_n =
        kEarthRotationRate * Eigen::Vector3d(std::cos(kLatitude), 0.0, -std::sin(kLatitude));
    const Eigen::Matrix3d C_nb = rotation_from_euler({0.0, 0.0, yaw_});
    yaw_ = wrap_to_pi(yaw_ + rate * kDt);
    time_ = time_.plus_nanoseconds(10'000'000);
    ImuSample sample;
    sample.time = time_;
    sample.interval_ns = 10'000'000;
    sample.delta_theta_b =
        kDt * (Eigen::Vector3d(0.0, 0.0, rate) + C_nb.transpose() * earth_n + gyro_bias_b_) +
        std::sqrt(kDt) * imu_.angle_random_walk * three();
    sample.delta_velocity_b =
        kDt * (force_b + accel_bias_b_) + std::sqrt(kDt) * imu_.velocity_random_walk * three();
    return sample;
  }

  double yaw() const { return yaw_; }
  double speed() const { return speed_; }
  // North, east, m/s, as a receiver sees it.
  Eigen::Vector2d v_n(double sigma) {
    const Eigen::Vector3d noise = sigma * three();
    return speed_ * Eigen::Vector2d(std::cos(yaw_), std::sin(yaw_)) + noise.head<2>();
  }

  static constexpr double kLatitude = 0.7;

 private:
  Eigen::Vector3d three() {
    Eigen::Vector3d v;
    for (int i = 0; i < 3; ++i) v[i] = normal_(bits_);
    return v;
  }

  ImuErrorModel imu_;
  std::mt19937_64 bits_;
  std::normal_distribution<double> normal_;
  double yaw_, speed_ = 0.0;
  GpsTime time_ = GpsTime::from_week_and_tow(2400, 0.0);
  Eigen::Vector3d gyro_bias_b_, accel_bias_b_;
};

}  // namespace leonav::test
