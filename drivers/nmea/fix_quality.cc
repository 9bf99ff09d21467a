#include "drivers/nmea/fix_quality.h"

#include <cmath>

namespace leonav {

FixQuality quality_of(const Solution& solution, double dead_reckoning_limit_m) {
  if (solution.source == Source::kNone) return {};
  if (solution.source != Source::kInsOnly) return {true, '1', 'A', 'A', '3'};
  const double sigma_m = std::hypot(solution.sigma_p_n[0], solution.sigma_p_n[1]);
  return {true, '6', 'E', sigma_m <= dead_reckoning_limit_m ? 'A' : 'V', '3'};
}

}  // namespace leonav
