// A wheel that counts whole pulses along a motion.
#pragma once
#include "core/ins/odometer.h"
#include "tools/motion/spline_motion.h"
#include "tools/sim/scenario/odometer_config.h"

namespace leonav::sim {

class PulseCounter {
 public:
  // `motion` must outlive it.
  PulseCounter(const OdometerConfig& config, const SplineMotion& motion);

  // The next increment, if it ends by `until_s` from the start and the motion lasts.
  bool next(double until_s, OdometerIncrement* increment);

 private:
  double forward_speed(double t) const;
  void roll(double to_s);

  OdometerConfig config_;
  const SplineMotion& motion_;
  long increments_ = 0;
  double now_s_ = 0.0, speed_m_s_;
  double rolled_m_;  // by the wheel's rim, as the counter takes it; starts between two pulses
  double counted_m_ = 0.0;  // whole pulses of it
};

}  // namespace leonav::sim
