// The mean specific force against gravity: its size tells the unit, its direction the axes.
#pragma once
#include <Eigen/Core>

#include "core/conventions/convention.h"
#include "core/conventions/motion_record.h"

namespace leonav {

// Of a vehicle that accelerates to and fro the mean specific force is minus gravity, whatever it
// does; nothing but the accelerometers is needed.
struct MeanForce {
  int seconds = 0;
  double ratio = 0.0;                                // median |specific force| over gravity
  Eigen::Vector3d mean_b = Eigen::Vector3d::Zero();  // over gravity
  double tilt() const;                               // rad, between body down and minus this
  bool known() const;                                // enough of it
};
enum class MotionSeconds : unsigned char { kAll, kWithCourse };
MeanForce mean_force(const MotionRecord& record, MotionSeconds which = MotionSeconds::kAll);

// What its size says. kNone while it is not known, or is right within 30 %.
ConventionFinding check_force_size(const MeanForce& force, double imu_interval_s);

}  // namespace leonav
