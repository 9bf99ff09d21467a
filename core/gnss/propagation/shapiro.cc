#include "core/gnss/propagation/shapiro.h"

#include <cmath>

#include "core/earth/ellipsoid.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

double shapiro_delay_m(const Eigen::Vector3d& p_sat_e, const Eigen::Vector3d& p_a_e) {
  constexpr double kScale = 2.0 * kEarthGravitationalConstant / (kSpeedOfLight * kSpeedOfLight);
  const double sum = p_sat_e.norm() + p_a_e.norm();
  const double range = (p_sat_e - p_a_e).norm();
  if (!(sum > range)) return 0.0;
  return kScale * std::log((sum + range) / (sum - range));
}

}  // namespace leonav
