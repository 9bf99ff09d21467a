#include "core/navigator/monitors/code_combination_monitor.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/square.h"
#include "core/filter/error_model/error_class.h"

namespace leonav {
namespace {

constexpr double kMean_s = 10.0;
// Logarithms of the ratio of information from which on the choice changes, to and fro.
constexpr double kClearlyBetter = 0.3, kWorse = -0.1;
// Share of the variance of the ionosphere's error that moves the position; most goes into the clock
// and into the zenith delay that the filter estimates.
constexpr double kCommonShare = 0.2;

// Returns the logarithm of the variance with pairs over that with single frequencies; nullopt: no
// pair.
std::optional<double> log_variance_ratio(const MeasurementEpoch& epoch,
                                         const LearnedErrors& errors) {
  double pair = 0.0, single = 0.0, ionosphere = 0.0, count = 0.0;
  const SatelliteInView* last = nullptr;
  for (const Measurement& code : epoch.measurements) {
    const SatelliteInView& satellite = epoch.satellites[code.satellite_index];
    if (code.observable != Observable::kCode || &satellite == last) continue;
    last = &satellite;
    const CodeVariances& variances = satellite.code_variances;
    if (!(variances.pair_noise > 0.0)) continue;
    const double scale = square(errors.sigma_scale(errors.class_of(code, satellite, false)));
    pair += 1.0 / (scale * variances.pair_noise);
    single += 1.0 / (scale * variances.single_noise);
    ionosphere += variances.ionosphere;
    count += 1.0;
  }
  if (!(pair > 0.0)) return std::nullopt;
  return std::log((1.0 / pair) / (1.0 / single + kCommonShare * ionosphere / count));
}

}  // namespace

void CodeCombinationMonitor::add(const MeasurementEpoch& epoch, const LearnedErrors& errors,
                                 bool carriers_keep_position) {
  if (configured_ != CodeCombination::kAutomatic || !errors.learns()) return;
  const double interval_s = last_time_.is_set() ? seconds_between(epoch.time, last_time_) : 0.0;
  last_time_ = epoch.time;
  const auto log_ratio =
      carriers_keep_position ? std::optional(kWorse - 1.0) : log_variance_ratio(epoch, errors);
  if (!log_ratio) return;
  log_ratio_ += (*log_ratio - log_ratio_) * std::clamp(interval_s / kMean_s, 0.0, 1.0);
  if (log_ratio_ > kClearlyBetter) single_ = true;
  if (log_ratio_ < kWorse) single_ = false;
}

CodeCombination CodeCombinationMonitor::combination() const {
  if (configured_ != CodeCombination::kAutomatic) return configured_;
  return single_ ? CodeCombination::kSingleFrequency : CodeCombination::kIonosphereFree;
}

}  // namespace leonav
