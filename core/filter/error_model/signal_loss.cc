#include "core/filter/error_model/signal_loss.h"

#include <algorithm>
#include <numbers>

namespace leonav {
namespace {

constexpr double kDecay_db_per_s = 0.3 / 60.0;

}  // namespace

void SignalLoss::reset() { references_.fill({}); }

std::optional<std::size_t> SignalLoss::place_of(const SatelliteInView& satellite) {
  if (!is_valid(satellite.satellite) || !(satellite.cn0_dbhz > 0.0)) return std::nullopt;
  if (satellite.satellite.system == System::kLeo) {
    if (!(satellite.elevation > 0.0)) return std::nullopt;  // or it is not known
    const double step = satellite.elevation / (0.5 * std::numbers::pi) * kElevations;
    return kMaxEphemerisSatellites + static_cast<std::size_t>(std::min(step, kElevations - 1.0));
  }
  const std::size_t index = table_index_of(satellite.satellite);
  return index < kMaxEphemerisSatellites ? std::optional(index) : std::nullopt;
}

void SignalLoss::add(const MeasurementEpoch& epoch) {
  for (const SatelliteInView& satellite : epoch.satellites) {
    const auto place = place_of(satellite);
    if (!place) continue;
    Reference& reference = references_[*place];
    const double passed_s =
        reference.time.is_set() ? std::max(seconds_between(epoch.time, reference.time), 0.0) : 0.0;
    reference.cn0_dbhz =
        std::max(reference.cn0_dbhz - kDecay_db_per_s * passed_s, satellite.cn0_dbhz);
    reference.time = epoch.time;
  }
}

double SignalLoss::loss_db(const SatelliteInView& satellite) const {
  const auto place = place_of(satellite);
  return place ? std::max(references_[*place].cn0_dbhz - satellite.cn0_dbhz, 0.0) : 0.0;
}

}  // namespace leonav
