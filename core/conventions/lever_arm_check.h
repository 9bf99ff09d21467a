// Where the antenna is, by how it swings about the IMU in turns.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/conventions/convention.h"
#include "core/gnss/point_solution.h"
#include "core/ins/imu.h"

namespace leonav {

// The antenna's velocity changes by what the accelerometers feel and by how omega x arm changes.
// A least-squares fit over seconds gives arm and accelerometer bias. Turns on level ground tell
// nothing of the vertical part of the arm: it is left out of the judgement.
class LeverArmCheck {
 public:
  explicit LeverArmCheck(const Eigen::Vector3d& lever_arm_b);
  void clear();
  void add(const ImuSample& sample);
  // At the end of a second. `q_eb`: the filter's attitude then; nullptr: it has none, or there is
  // no solution.
  void end_second(GpsTime time, const PointSolution* point, const Eigen::Quaterniond* q_eb);
  ConventionFinding judge() const;
  bool is_known() const;  // well enough that a wrong arm would be seen

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
  // Over the second: where the body axes at its start are seen from, and the force in them.
  Eigen::Quaterniond q_0b_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_0_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_b_ = Eigen::Vector3d::Zero();  // the last 50 ms, rad/s
  double imu_s_ = 0.0;
  bool has_start_ = false;
  GpsTime start_;
  Eigen::Vector3d start_v_e_ = Eigen::Vector3d::Zero(), start_rate_b_ = start_v_e_;
  // Normal equations of (arm less the one told, bias).
  Matrix6d normal_ = Matrix6d::Zero();
  Vector6d right_ = Vector6d::Zero();
  double squares_ = 0.0;
  int seconds_ = 0;
};

}  // namespace leonav
