#include "core/navigator/monitors/orbit_error_monitor.h"

#include <algorithm>

namespace leonav {

std::optional<double> OrbitErrorMonitor::add(const LastingErrors& errors) {
  constexpr double kGrown = 2.0;
  double largest_m = 0.0;
  for (const System system : kSystems) {
    double& reported_m = reported_m_[index_of(system)];
    const double sigma_m = errors.own_sigma_m(system);
    if (sigma_m == 0.0) reported_m = 0.0;
    if (!(sigma_m > kGrown * reported_m)) continue;
    reported_m = sigma_m;
    largest_m = std::max(largest_m, sigma_m);
  }
  return largest_m > 0.0 ? std::optional(largest_m) : std::nullopt;
}

}  // namespace leonav
