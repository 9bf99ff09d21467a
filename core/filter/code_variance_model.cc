#include "core/filter/code_variance_model.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/filter/state/signal_states.h"

namespace leonav {
namespace {

// Arcs that go on: enough for a change of position, one of the clock, and one more.
constexpr int kMinContinuousArcs = 5;
constexpr int kContinuousPerBroken = 10;
constexpr double kFrequentBreaksMemory_s = 600.0;  // a receiver with frequent breaks goes on so
constexpr double kNewArcs_s = 5.0;

}  // namespace

void CodeVarianceModel::reset() {
  weighting_.clear();
  new_arcs_until_ = frequent_arc_breaks_until_ = GpsTime();
}

void CodeVarianceModel::accept(const FilterMeasurements& measurements) {
  for (const FilterMeasurement& measurement : measurements)
    if (measurement.factor > 0.0) weighting_.accept(measurement.code_weighting_entry);
}

void CodeVarianceModel::begin_epoch(const MeasurementEpoch& epoch, const SignalStates& ambiguities,
                                    GpsTime last_update) {
  continuity_ = evaluate_carrier_continuity(epoch, ambiguities, last_update);
  if (continuity_ == CarrierContinuity::kNone) weighting_.clear();
}

CodeVarianceModel::CarrierContinuity CodeVarianceModel::evaluate_carrier_continuity(
    const MeasurementEpoch& epoch, const SignalStates& ambiguities, GpsTime last_update) {
  if (is_static_) return CarrierContinuity::kContinuous;
  int held = 0, broken = 0;
  for (const Measurement& carrier : epoch.measurements) {
    if (carrier.observable != Observable::kCarrier || carrier.reason != Reason::kUsed ||
        carrier.satellite_index >= epoch.satellites.size())
      continue;
    const SatelliteInView& satellite = epoch.satellites[carrier.satellite_index];
    const int index = find_ambiguity(ambiguities, carrier.arc);
    if (index != kNoSignalState) {
      held += ambiguities[static_cast<std::size_t>(index)].last_used == last_update ? 1 : 0;
    } else {
      broken += satellite.arc_causes.any() ? 1 : 0;
    }
  }
  const auto lasts = [&epoch](GpsTime until) { return until.is_set() && epoch.time <= until; };
  if (held == 0) {
    new_arcs_until_ = epoch.time.plus_seconds(kNewArcs_s);
    weighting_.clear();
  } else if (held < kMinContinuousArcs || broken > std::max(1, held / kContinuousPerBroken)) {
    frequent_arc_breaks_until_ = epoch.time.plus_seconds(kFrequentBreaksMemory_s);
  }
  if (lasts(frequent_arc_breaks_until_)) return CarrierContinuity::kNone;
  return lasts(new_arcs_until_) ? CarrierContinuity::kNewArcs : CarrierContinuity::kContinuous;
}

std::optional<double> CodeVarianceModel::weigh(const MeasurementEpoch& epoch,
                                               const Measurement& code, double inflation,
                                               double correlation_time_ratio,
                                               FilterMeasurement* entry) {
  const SatelliteInView& satellite = epoch.satellites[code.satellite_index];
  const double correlated = square(code.correlated_sigma);
  if (continuity_ == CarrierContinuity::kNone || !(correlated > 0.0) ||
      !(code.correlation_time_s > 0.0)) {
    entry->gain_variance = inflation * entry->variance;
    return std::nullopt;
  }
  ColoredCodeWeighting::CodeErrorModel error_model;
  error_model.orbit_issue = satellite.orbit_issue;
  error_model.correlation_time_s = correlation_time_ratio * code.correlation_time_s;
  for (const Measurement& carrier : epoch.measurements) {
    if (carrier.observable != Observable::kCarrier ||
        carrier.satellite_index != code.satellite_index)
      continue;
    error_model.random_walk = carrier.random_walk;
    error_model.disturbance_m = carrier.disturbance_m;
  }
  const double noise = inflation * std::max(entry->variance - correlated, 0.0);
  const double scheduled = weighting_.weigh(code, satellite.satellite, error_model, noise,
                                            epoch.time, &entry->code_weighting_entry);
  // It is not known whether new arcs last: their codes count in full, but are remembered.
  const bool lasts = continuity_ != CarrierContinuity::kNewArcs;
  entry->gain_variance = lasts ? scheduled : inflation * entry->variance;
  return lasts ? std::optional<double>(std::max(scheduled - noise, 0.0)) : std::nullopt;
}

}  // namespace leonav
