#include "core/filter/attitude_convergence.h"

#include <algorithm>

namespace leonav {
namespace {

// rad; an attitude known so well needs no further step.
constexpr double kConvergedTilt = 1e-3, kConvergedHeading = 4e-3;

}  // namespace

bool AttitudeConvergence::advance(const Eigen::Vector3d& sigma_n, double share) {
  const double tilt = std::max(kConvergedTilt, sigma_n.head<2>().maxCoeff());
  const double heading = std::max(kConvergedHeading, sigma_n.z());
  const bool better = tilt < share * tilt_sigma_ || heading < share * heading_sigma_;
  if (!better) return false;
  tilt_sigma_ = std::min(tilt_sigma_, tilt);
  heading_sigma_ = std::min(heading_sigma_, heading);
  return true;
}

}  // namespace leonav
