// SmoothTrack fits a motion with continuous acceleration and rate to recorded positions.
#pragma once
#include <vector>

#include "drivers/csv/truth_csv.h"
#include "tools/sim/motion/spline_motion.h"

namespace leonav {

// Settings of the fit.
struct SmoothTrackOptions {
  double position_cutoff_hz = 1.0;  // motion faster than this counts as noise of the truth
  double attitude_cutoff_hz = 0.5;
  double min_course_speed_m_s = 1.0;  // below, the heading is held
  double max_turn_rate_rad_s = 0.5;   // at standstill, towards the course of the next start
  double max_slope = 0.25;            // rad; steeper is a jump of the truth, not a road
  double max_gap_s = 2.0;             // a longer gap in the truth is an error
};

// SmoothTrack computes the motion when it is constructed.
class SmoothTrack {
 public:
  // Throws std::runtime_error if there are too few points, or a gap.
  SmoothTrack(const std::vector<TruthPoint>& points, const SmoothTrackOptions& options);

  // The heading is along the course while it moves, the pitch along the slope; roll is zero.
  const SplineMotion& motion() const { return motion_; }

  double rms_deviation_m() const { return rms_deviation_m_; }
  double max_deviation_m() const { return max_deviation_m_; }

 private:
  void fit_position(const std::vector<TruthPoint>& points, double interval_s);
  void fit_attitude(double interval_s);

  SmoothTrackOptions options_;
  std::vector<double> times_;  // of the truth, s from start
  MotionSplines splines_;
  SplineMotion motion_;
  double rms_deviation_m_ = 0.0, max_deviation_m_ = 0.0;
};

}  // namespace leonav
