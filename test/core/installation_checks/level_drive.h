// A vehicle on level ground: stands, sets off, brakes and turns both ways.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/gnss/positioning/point_solution.h"
#include "core/inertial/strapdown/imu.h"

namespace leonav::test {

inline const Eigen::Vector3d kDown = Eigen::Vector3d::UnitZ();

class LevelDrive {
 public:
  static constexpr double kGravity = 9.81;
  explicit LevelDrive(const Eigen::Vector3d& lever_arm_b = Eigen::Vector3d::Zero())
      : lever_arm_b_(lever_arm_b) {}

  GpsTime time() const { return kStart.plus_seconds(t_); }
  double seconds() const { return t_; }

  // The next sample, 100 Hz: what a right IMU measures.
  ImuSample next() {
    const double dt = 0.01, rate = turn_rate(), push = acceleration();
    ImuSample sample;
    sample.interval_ns = 10'000'000;
    sample.delta_theta_b = Eigen::Vector3d(0.0, 0.0, rate) * dt;
    sample.delta_velocity_b = Eigen::Vector3d(push, speed_ * rate, -kGravity) * dt;
    ++steps_;
    t_ = 0.01 * steps_;
    sample.time = time();
    speed_ += push * dt;
    heading_ += rate * dt;
    return sample;
  }

  // What the receiver tells of the antenna now.
  PointSolution point() const {
    PointSolution point;
    point.status = PointStatus::kOk;
    point.has_velocity = true;
    point.p_e = to_ecef({0.8, 0.2, 100.0});
    const Eigen::Vector3d swing_b = Eigen::Vector3d(0.0, 0.0, turn_rate()).cross(lever_arm_b_);
    point.v_e = q_eb() * (Eigen::Vector3d(speed_, 0.0, 0.0) + swing_b);
    point.covariance_v_e = 0.05 * 0.05 * Eigen::Matrix3d::Identity();
    return point;
  }
  Eigen::Quaterniond q_eb() const {
    const Eigen::Matrix3d C_en = rotation_ecef_to_ned({0.8, 0.2, 100.0}).transpose();
    return Eigen::Quaterniond(C_en * rotation_from_euler({0.0, 0.0, heading_}));
  }

 private:
  static constexpr double kStanding_s = 12.0, kLap_s = 40.0;
  // A lap: off, a bend to the right, slower, a bend to the left, back to walking pace.
  double lap_s() const { return t_ < kStanding_s ? -1.0 : std::fmod(t_ - kStanding_s, kLap_s); }
  double acceleration() const {
    const double t = lap_s();
    if (t < 0.0) return 0.0;
    if (t < 6.0) return 1.5;
    if (t >= 18.0 && t < 20.0) return -1.5;
    return t >= 34.0 ? -1.0 : 0.0;
  }
  double turn_rate() const {
    const double t = lap_s();
    // Within seconds, so that no rate changes where one ends.
    if (t >= 9.5 && t < 15.5) return 0.25;
    return t >= 22.5 && t < 27.5 ? -0.3 : 0.0;
  }

  static inline const GpsTime kStart = GpsTime::from_nanoseconds(1'300'000'000'000'000'000);
  Eigen::Vector3d lever_arm_b_;
  long steps_ = 0;
  double t_ = 0.0, speed_ = 0.0, heading_ = 0.4;
};

// Feeds a second of the drive to anything with add(ImuSample); `change` makes the mistake.
template <typename Target, typename Change>
void feed_second(LevelDrive* drive, Target* target, Change change) {
  for (int i = 0; i < 100; ++i) {
    ImuSample sample = drive->next();
    change(&sample);
    target->add(sample);
  }
}

inline void nothing(ImuSample*) {}

}  // namespace leonav::test
