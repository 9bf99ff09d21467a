// YawRateFit compares the gyros with the course over ground: unit, sign, axis and stamps.
#pragma once
#include <Eigen/Core>

#include "core/installation_checks/convention.h"
#include "core/installation_checks/internal/mean_force.h"
#include "core/installation_checks/internal/motion_record.h"

namespace leonav {

// YawRateFit fits the rate about an axis as a multiple of the course's rate, over all seconds with
// both.
struct YawRateFit {
  int seconds = 0;
  double span_s = 0.0;  // from the first such second to the last
  double turned = 0.0;  // rad, sum of the course's turns in both directions
  double slope = 0.0;
  double correlation = 0.0;  // squared correlation
  // Median of the ratio of both rates over the seconds that turn: one second with a wrong course,
  // from reflected Dopplers, may give the line its slope, but not the median. 0: none turns.
  double median_ratio = 0.0;
  // It has turned by more than one bend, and the rates follow the course.
  bool follows() const;
  // It has turned by more than one bend, and the rates do not follow the course.
  bool contradicts() const;
};
// Fits the rate about `axis_b` (unit vector) against the course; `lag_s` compares the course of a
// second with the rate that much later.
YawRateFit fit_yaw_rate(const MotionRecord& record, const Eigen::Vector3d& axis_b, int lag_s = 0);

// Tests the size of the turn about the vertical that the accelerometers show. Returns kNone if it
// is right within 30 %, of either sign, by the line or by the median, or not known.
ConventionFinding check_yaw_rate_scale(const YawRateFit& about_vertical, double imu_interval_s);

// Tests, where hardly any rate about the vertical is measured, whether the gyro of another axis
// follows the course.
ConventionFinding check_yaw_rate_axis(const MotionRecord& record, const YawRateFit& about_vertical);

// Tests, where the gyros do not follow the course, whether they do at another lag.
ConventionFinding check_yaw_rate_delay(const MotionRecord& record, const MeanForce& force);

}  // namespace leonav
