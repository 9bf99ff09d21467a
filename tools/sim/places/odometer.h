// Odometer gives the distance that the vehicle has travelled.
#pragma once
#include <vector>

#include "tools/sim/motion/spline_motion.h"

namespace leonav::sim {

// Odometer tabulates the motion when it is constructed.
class Odometer {
 public:
  explicit Odometer(const SplineMotion& motion);

  // Returns the horizontal and vertical distance since the start, m; beyond both ends the value at
  // the end.
  double travelled_m(double t) const;
  double speed_m_s(double t) const;
  // Returns the time of that distance; the end if it is never reached.
  double when_s(double travelled_m) const;

 private:
  std::vector<double> travelled_;  // every kStep_s
};

}  // namespace leonav::sim
