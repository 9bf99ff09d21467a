// LeverArmMonitor measures the lever arm by the antenna's motion about the IMU in turns.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/gnss/positioning/point_solution.h"
#include "core/inertial/strapdown/imu.h"
#include "core/installation_checks/convention.h"

namespace leonav {

// LeverArmMonitor fits lever arm and accelerometer bias over seconds by least squares:
//
//   change of v_antenna - (integral of f + gravity + Coriolis) = C(t1) (w(t1) x l) - C(t0) (w(t0) x
//   l) + bias dt
//
// in body axes. Turns on level ground do not show the vertical part of the arm, which is not
// tested.
class LeverArmMonitor {
 public:
  // `lever_arm_b`: m, configured, body axes.
  explicit LeverArmMonitor(const Eigen::Vector3d& lever_arm_b);
  void clear();
  void add(const ImuSample& sample);
  // Ends a second at `time`. `q_eb` is the filter's attitude at that instant; nullptr if it has
  // none, or if there is no solution.
  void end_second(GpsTime time, const PointSolution* point, const Eigen::Quaterniond* q_eb);
  // Returns a finding if the measured arm clearly differs from the configured one.
  ConventionFinding evaluate() const;
  // Returns whether the arm is measured well enough to detect a wrong one.
  bool is_known() const;

 private:
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  using Matrix6d = Eigen::Matrix<double, 6, 6>;
  struct Fit {
    Eigen::Vector3d arm_b = Eigen::Vector3d::Zero();
    double sigma = 0.0;  // the larger of the two horizontal ones, m
  };
  Fit fit() const;
  void begin_second();

  Eigen::Vector3d lever_arm_b_;
  // Over the second: attitude relative to its start, and the integral of the force in the axes at
  // the start.
  Eigen::Quaterniond q_0b_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_0_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_b_ = Eigen::Vector3d::Zero();  // mean of the last 50 ms, rad/s
  double imu_s_ = 0.0;
  bool has_start_ = false;
  GpsTime start_;
  Eigen::Vector3d start_v_e_ = Eigen::Vector3d::Zero(), start_rate_b_ = start_v_e_;
  // Normal equations of (arm minus configured arm, bias).
  Matrix6d normal_ = Matrix6d::Zero();
  Vector6d right_ = Vector6d::Zero();
  double squares_ = 0.0;
  int seconds_ = 0;
};

}  // namespace leonav
