// AttitudeConvergence notices when the attitude has become much better known than it was.
#pragma once
#include <Eigen/Core>
#include <limits>

namespace leonav {

// While a wrong attitude is being corrected, the correction looks like a body that tilts, and the
// filter attributes part of it to lever arm and time offset. Ekf therefore gives the vehicle
// constants their start variance again at each step of this convergence.
class AttitudeConvergence {
 public:
  void reset() { *this = AttitudeConvergence(); }
  // True where tilt or heading fell below `share` of its value at the last such step. `sigma_n`:
  // about north, east and down, rad. A tilt below 1e-3 rad or a heading below 4e-3 rad counts as
  // that value.
  bool advance(const Eigen::Vector3d& sigma_n, double share);

 private:
  // Infinite: no attitude yet.
  double tilt_sigma_ = std::numeric_limits<double>::infinity();
  double heading_sigma_ = std::numeric_limits<double>::infinity();
};

}  // namespace leonav
