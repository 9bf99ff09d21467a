#include "tools/sim/signals/signal_strength.h"

#include <algorithm>
#include <cmath>

namespace leonav::sim {

double elevation_loss_db(const Cn0Config& config, double elevation) {
  return config.horizon_loss_db * (1.0 - std::sqrt(std::max(0.0, std::sin(elevation))));
}

double zenith_cn0_dbhz(const Cn0Config& config, System system, std::size_t signal) {
  return config.zenith_dbhz[index_of(system)] + (signal == 0 ? 0.0 : config.second_signal_db);
}

double noise_factor(double loss_db) { return std::pow(10.0, 0.05 * loss_db); }

}  // namespace leonav::sim
