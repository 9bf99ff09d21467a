#include "core/navigator/monitors/orbit_error_monitor.h"

namespace leonav {

std::optional<OrbitErrorMonitor::Finding> OrbitErrorMonitor::add(
    const std::array<double, kSystemCount>& lasting_sigma_m) {
  constexpr double kGrown = 2.0;
  std::optional<Finding> finding;
  for (const System system : kSystems) {
    double& reported_m = reported_m_[index_of(system)];
    const double sigma_m = lasting_sigma_m[index_of(system)];
    if (sigma_m == 0.0) reported_m = 0.0;
    if (!(sigma_m > kGrown * reported_m)) continue;
    if (!finding || sigma_m > finding->range_sigma_m) finding = Finding{system, sigma_m};
  }
  if (finding) reported_m_[index_of(finding->system)] = finding->range_sigma_m;
  return finding;
}

}  // namespace leonav
