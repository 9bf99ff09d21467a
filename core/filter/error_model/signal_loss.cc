#include "core/filter/error_model/signal_loss.h"

#include <algorithm>

namespace leonav {
namespace {

constexpr double kDecay_db_per_s = 0.3 / 60.0;

}  // namespace

void SignalLoss::reset() { references_.fill({}); }

void SignalLoss::add(const MeasurementEpoch& epoch) {
  for (const SatelliteInView& satellite : epoch.satellites) {
    if (!is_valid(satellite.satellite) || !(satellite.cn0_dbhz > 0.0)) continue;
    const std::size_t index = table_index_of(satellite.satellite);
    if (index >= references_.size()) continue;
    Reference& reference = references_[index];
    const double passed_s =
        reference.time.is_set() ? std::max(seconds_between(epoch.time, reference.time), 0.0) : 0.0;
    reference.cn0_dbhz =
        std::max(reference.cn0_dbhz - kDecay_db_per_s * passed_s, satellite.cn0_dbhz);
    reference.time = epoch.time;
  }
}

double SignalLoss::loss_db(const SatelliteInView& satellite) const {
  if (satellite.satellite.system == System::kLeo || !is_valid(satellite.satellite) ||
      !(satellite.cn0_dbhz > 0.0))
    return 0.0;
  const std::size_t index = table_index_of(satellite.satellite);
  if (index >= references_.size()) return 0.0;
  return std::max(references_[index].cn0_dbhz - satellite.cn0_dbhz, 0.0);
}

}  // namespace leonav
