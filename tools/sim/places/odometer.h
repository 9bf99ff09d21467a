// How far the vehicle has gone.
#pragma once
#include <vector>

#include "tools/motion/spline_motion.h"

namespace leonav::sim {

class Odometer {
 public:
  explicit Odometer(const SplineMotion& motion);

  // Horizontal and vertical way since the start, m; beyond both ends as at them.
  double travelled_m(double t) const;
  double speed_m_s(double t) const;
  // When it had gone so far; the end if it never does.
  double when_s(double travelled_m) const;

 private:
  std::vector<double> travelled_;  // every kStep_s
};

}  // namespace leonav::sim
