// HorizontalAxesFit finds which horizontal IMU axis points forward, from specific force and course.
#pragma once
#include <Eigen/Core>

#include "core/installation_checks/convention.h"
#include "core/installation_checks/internal/mean_force.h"
#include "core/installation_checks/internal/motion_record.h"

namespace leonav {

// HorizontalAxesFit holds the horizontal forces as a linear map of the accelerations forward and
// right.
struct HorizontalAxesFit {
  bool known = false;  // enough braking and turning, and the forces follow
  // The map is the sum of a rotation and a mirrored rotation, each times its size: (cos, -sin; sin,
  // cos) and (cos, sin; sin, -cos). Correct axes give turn 0, size 1 and no mirrored part.
  double turn = 0.0, turn_size = 0.0;          // rad
  double mirrored = 0.0, mirrored_size = 0.0;  // rad
  bool is_turn() const;
  bool is_mirrored() const;
  bool is_right() const;
};
// Fits the seconds at `min_speed` (m/s) and above.
HorizontalAxesFit fit_horizontal_axes(const MotionRecord& record, double min_speed);

// Interprets the map if the third axis points down and the gyros turn with the course. The value is
// in degrees.
ConventionFinding check_horizontal_axes_upright(const HorizontalAxesFit& fit);
// Interprets the map if the third axis points up and the gyros agree with that.
ConventionFinding check_horizontal_axes_upside_down(const HorizontalAxesFit& fit,
                                                    const MeanForce& force);

}  // namespace leonav
