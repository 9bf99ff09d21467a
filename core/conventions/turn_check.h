// The gyros against the course over ground: unit, sign, axis and stamps.
#pragma once
#include <Eigen/Core>

#include "core/conventions/convention.h"
#include "core/conventions/force_check.h"
#include "core/conventions/motion_record.h"

namespace leonav {

// The rate about an axis as a multiple of the course's, fitted over all seconds with both.
struct TurnFit {
  int seconds = 0;
  double span_s = 0.0;  // from the first of them to the last
  double turned = 0.0;  // rad, of the course, both ways added up
  double slope = 0.0;
  double correlation = 0.0;  // squared
  // It has turned by more than a bend's worth, and the rates do follow the course.
  bool follows() const;
  bool contradicts() const;  // likewise, and the rates do not
};
// `axis_b`: of unit length. `lag_s`: the course of a second against the rate so much later.
TurnFit fit_turns(const MotionRecord& record, const Eigen::Vector3d& axis_b, int lag_s = 0);

// Size of the turn about the vertical that the accelerometers show. kNone where it is right within
// 30 % (whatever its sign), or not known.
ConventionFinding check_turn_size(const TurnFit& about_vertical, double imu_interval_s);

// Where hardly anything turns about the vertical: whether the gyro of another axis does as the
// course.
ConventionFinding check_turn_axis(const MotionRecord& record, const TurnFit& about_vertical);

// Where the gyros do not follow the course: whether they do at another time.
ConventionFinding check_turn_time(const MotionRecord& record, const MeanForce& force);

}  // namespace leonav
