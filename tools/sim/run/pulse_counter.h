// PulseCounter simulates a wheel that counts whole pulses along a motion.
#pragma once
#include "core/inertial/strapdown/odometer.h"
#include "tools/sim/motion/spline_motion.h"
#include "tools/sim/scenario/odometer_config.h"

namespace leonav::sim {

// PulseCounter returns the increments in order of time.
class PulseCounter {
 public:
  // `motion` must outlive this object.
  PulseCounter(const OdometerConfig& config, const SplineMotion& motion);

  // Returns the next increment if it ends by `until_s` after the start, within the motion.
  bool next(double until_s, OdometerIncrement* increment);

 private:
  double forward_speed(double t) const;
  void roll(double to_s);

  OdometerConfig config_;
  const SplineMotion& motion_;
  long increments_ = 0;
  double now_s_ = 0.0, speed_m_s_;
  double rolled_m_;         // distance of the wheel's rim, with slip; it starts between two pulses
  double counted_m_ = 0.0;  // the whole pulses in rolled_m_
};

}  // namespace leonav::sim
