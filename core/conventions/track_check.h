// The horizontal specific force against what the course over ground says: which axis is forward.
#pragma once
#include <Eigen/Core>

#include "core/conventions/convention.h"
#include "core/conventions/force_check.h"
#include "core/conventions/motion_record.h"

namespace leonav {

// Forces on the first two axes as a linear map of the accelerations forward and to the right.
struct TrackFit {
  bool known = false;  // braked and turned enough, and the forces do follow
  // The map as a turn and a turn of the mirrored: (cos, -sin; sin, cos) and (cos, sin; sin, -cos),
  // each times its size. A vehicle with right axes: turn 0, size 1, and no mirrored part.
  double turn = 0.0, turn_size = 0.0;          // rad
  double mirrored = 0.0, mirrored_size = 0.0;  // rad
  bool is_turn() const;
  bool is_mirrored() const;
  bool is_right() const;
};
// Of seconds at `min_speed` (m/s) and above.
TrackFit fit_track(const MotionRecord& record, double min_speed);

// The third axis points down, as it should, and the gyros turn as the course does.
ConventionFinding check_track_upright(const TrackFit& fit);
// The third axis points up, and the gyros agree with that: what the first two are.
ConventionFinding check_track_upside_down(const TrackFit& fit, const MeanForce& force);

}  // namespace leonav
