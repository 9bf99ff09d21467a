#include "core/filter/code_variance_model.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/filter/error_model/error_correlation.h"
#include "core/filter/state/ambiguities.h"

namespace leonav {
namespace {

// Arcs that go on: enough for a change of position, one of the clock, and one more.
constexpr int kMinContinuousArcs = 5;
constexpr int kContinuousPerBroken = 10;
constexpr double kFrequentBreaksMemory_s = 600.0;  // a receiver with frequent breaks goes on so
constexpr double kNewArcs_s = 5.0;
constexpr double kMemoryShare = 0.05, kLongestLasting_s = 20.0;
constexpr double kMeanOfGains_s = 10.0, kLeastGain = 1e-4;

}  // namespace

void CodeVarianceModel::reset() {
  weighting_.clear();
  mean_gain_ = 1.0;
  position_memory_s_ = 0.0;
  none_since_ = new_arcs_until_ = frequent_arc_breaks_until_ = GpsTime();
}

void CodeVarianceModel::accept(const FilterMeasurements& measurements) {
  for (const FilterMeasurement& measurement : measurements)
    if (measurement.factor > 0.0) weighting_.accept(measurement.code_weighting_entry);
}

void CodeVarianceModel::add_update(double before, double after, double interval_s) {
  if (!(before > 0.0) || !(interval_s > 0.0)) return;
  const double gain = std::clamp(1.0 - after / before, kLeastGain, 1.0);
  mean_gain_ += (gain - mean_gain_) * std::min(interval_s / kMeanOfGains_s, 1.0);
  position_memory_s_ = interval_s / mean_gain_;
}

void CodeVarianceModel::begin_epoch(const MeasurementEpoch& epoch, const Ambiguities& ambiguities,
                                    GpsTime last_update) {
  continuity_ = evaluate_carrier_continuity(epoch, ambiguities, last_update);
  interval_s_ = seconds_between(epoch.time, last_update);
  if (continuity_ == CarrierContinuity::kNone) weighting_.clear();
}

CodeVarianceModel::CarrierContinuity CodeVarianceModel::evaluate_carrier_continuity(
    const MeasurementEpoch& epoch, const Ambiguities& ambiguities, GpsTime last_update) {
  if (is_static_) return CarrierContinuity::kContinuous;
  int held = 0, broken = 0;
  for (const Measurement& carrier : epoch.measurements) {
    if (carrier.observable != Observable::kCarrier || carrier.reason != Reason::kUsed ||
        carrier.satellite_index >= epoch.satellites.size())
      continue;
    const SatelliteInView& satellite = epoch.satellites[carrier.satellite_index];
    const int index = find_ambiguity(ambiguities, carrier.arc);
    if (index != kNoAmbiguity) {
      held += ambiguities[static_cast<std::size_t>(index)].last_used == last_update ? 1 : 0;
    } else {
      broken += satellite.arc_causes.any() ? 1 : 0;
    }
  }
  const auto lasts = [&epoch](GpsTime until) { return until.is_set() && epoch.time <= until; };
  if (held > 0) none_since_ = GpsTime();
  if (held == 0) {
    if (!none_since_.is_set()) none_since_ = epoch.time;
    new_arcs_until_ = epoch.time.plus_seconds(kNewArcs_s);
    weighting_.clear();
  } else if (held < kMinContinuousArcs || broken > std::max(1, held / kContinuousPerBroken)) {
    frequent_arc_breaks_until_ = epoch.time.plus_seconds(kFrequentBreaksMemory_s);
  }
  const bool none_goes_on =
      none_since_.is_set() && seconds_between(epoch.time, none_since_) > kNewArcs_s;
  if (none_goes_on || lasts(frequent_arc_breaks_until_)) return CarrierContinuity::kNone;
  return lasts(new_arcs_until_) ? CarrierContinuity::kNewArcs : CarrierContinuity::kContinuous;
}

double CodeVarianceModel::inflated(double variance, double lasting_variance, double lasting_s,
                                   double inflation) const {
  const double lasting = std::min(lasting_variance, variance);
  const double counted_s =
      std::min({lasting_s, kMemoryShare * position_memory_s_, kLongestLasting_s});
  const double of_lasting = std::max(inflation, variance_inflation({1.0, counted_s}, interval_s_));
  return inflation * (variance - lasting) + of_lasting * lasting;
}

void CodeVarianceModel::weigh(const MeasurementEpoch& epoch, const Measurement& code,
                              double inflation, double correlation_time_ratio,
                              double reflected_walk, FilterMeasurement* entry) {
  const SatelliteInView& satellite = epoch.satellites[code.satellite_index];
  const double correlated = code.own_correlated_variance();
  if (continuity_ == CarrierContinuity::kNone || !(correlated > 0.0) ||
      !(code.correlation_time_s > 0.0)) {
    entry->gain_variance = inflated(entry->variance, correlated,
                                    correlation_time_ratio * code.correlation_time_s, inflation);
    return;
  }
  ColoredCodeWeighting::CodeErrorModel error_model;
  error_model.orbit_issue = satellite.orbit_issue;
  error_model.correlation_time_s = correlation_time_ratio * code.correlation_time_s;
  for (const Measurement& carrier : epoch.measurements) {
    if (carrier.observable != Observable::kCarrier ||
        carrier.satellite_index != code.satellite_index)
      continue;
    error_model.random_walk = std::hypot(carrier.random_walk, reflected_walk);
    error_model.disturbance_m = carrier.disturbance_m;
  }
  const double noise = inflation * std::max(entry->variance - correlated, 0.0);
  const double scheduled = weighting_.weigh(code, satellite.satellite, error_model, noise,
                                            epoch.time, &entry->code_weighting_entry);
  // It is not known whether new arcs last: their codes count in full, but are remembered.
  entry->gain_variance =
      continuity_ == CarrierContinuity::kNewArcs ? inflation * entry->variance : scheduled;
}

}  // namespace leonav
