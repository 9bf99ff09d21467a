// SplineMotion is a motion of the whole body in closed form: position and attitude as splines of
// time.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "drivers/csv/truth_csv.h"
#include "tools/sim/motion/smoothing_spline.h"

namespace leonav {

// State of the motion at one instant.
struct MotionInstant {
  Eigen::Vector3d p_e, v_e, a_e;  // a_e: second derivative in the rotating frame
  Eigen::Quaterniond q_eb;        // body forward-right-down to ECEF
  Eigen::Vector3d omega_ib_b;     // rad/s
};

// The splines, all over one span of seconds from `start`.
struct MotionSplines {
  GpsTime start;
  double duration_s = 0.0;
  Eigen::Vector3d origin_e = Eigen::Vector3d::Zero();
  std::array<SmoothingSpline, 3> position;  // e, from origin_e, m
  std::array<SmoothingSpline, 3> attitude;  // roll, pitch, yaw against north-east-down; rad,
                                            // yaw unwrapped
};

// SplineMotion evaluates the splines and their derivatives.
class SplineMotion {
 public:
  SplineMotion() = default;
  explicit SplineMotion(MotionSplines splines) : splines_(std::move(splines)) {}

  GpsTime start() const { return splines_.start; }
  double duration_s() const { return splines_.duration_s; }
  const MotionSplines& splines() const { return splines_; }
  // Returns the state at `t` seconds after start(), within the duration.
  MotionInstant at(double t) const;
  TruthPoint point(GpsTime time) const;  // all columns of truth.csv

 private:
  MotionSplines splines_;
};

}  // namespace leonav
