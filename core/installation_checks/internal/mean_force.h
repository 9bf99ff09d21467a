// MeanForce compares the mean specific force with gravity: its size shows the unit, its direction
// the vertical axis.
#pragma once
#include <Eigen/Core>

#include "core/installation_checks/convention.h"
#include "core/installation_checks/internal/motion_record.h"

namespace leonav {

inline constexpr double kStandardGravity = 9.80665;  // m/s^2

// MeanForce holds the mean over the recorded seconds. Over many changes of speed the accelerations
// cancel, and the mean is minus gravity whatever the vehicle does. Only accelerometers are needed.
struct MeanForce {
  int seconds = 0;
  double ratio = 0.0;                                // median |specific force| over gravity
  Eigen::Vector3d mean_b = Eigen::Vector3d::Zero();  // mean specific force over gravity
  double tilt() const;  // rad, between the body's down axis and minus the mean
  bool known() const;   // whether there are enough seconds
};
// Selects all seconds, or those in which the antenna moved.
enum class MotionSeconds : unsigned char { kAll, kWithCourse };
// Averages the record's seconds.
MeanForce mean_force(const MotionRecord& record, MotionSeconds which = MotionSeconds::kAll);

// Returns the mistake that the size indicates; kNone while it is not known, or is right within 30
// %.
ConventionFinding check_force_size(const MeanForce& force, double imu_interval_s);

}  // namespace leonav
