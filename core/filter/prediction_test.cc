#include "core/filter/prediction_test.h"

#include <cmath>
#include <utility>

#include "core/filter/innovation_tests/prediction_consistency.h"

namespace leonav {

using Action = PredictionVerdict::Action;

InnovationTables clock_removed_by_observable(const FilterMeasurements& measurements,
                                             const EkfCovariance& covariance) {
  InnovationTables tables;
  for (std::size_t kind = 0; kind < kObservables; ++kind)
    tables[kind] =
        clock_removed_innovations(measurements, static_cast<Observable>(kind), covariance);
  return tables;
}

const ClockRemovedInnovations& table_of(const InnovationTables& tables, Observable observable) {
  return tables[static_cast<std::size_t>(observable)];
}

void PredictionTest::reset() {
  ranges_inconsistent_ = doppler_inconsistent_ = false;
  last_consistent_time_ = GpsTime();
}

void PredictionTest::begin_epoch() {
  ranges_inconsistent_before_ = std::exchange(ranges_inconsistent_, false);
  doppler_inconsistent_before_ = std::exchange(doppler_inconsistent_, false);
}

double PredictionTest::missing_variance(Observable observable, const Evidence& evidence,
                                        RobustUpdate* robust_update) const {
  return unmodelled_prior_variance(robust_, evidence.measurements, observable,
                                   table_of(evidence.tables, observable), evidence.covariance,
                                   suspect_ratio_, robust_update);
}

PredictionVerdict PredictionTest::evaluate(Observable observable, const Evidence& evidence,
                                           RobustUpdate* robust_update) {
  const double variance = missing_variance(observable, evidence, robust_update);
  if (variance <= 0.0) return {};
  const bool doppler = observable == Observable::kDoppler;
  if (doppler) {
    doppler_inconsistent_ = true;
  } else {
    ranges_inconsistent_ = true;
    // The epoch may be what is wrong, its time stamp for one.
    if (!ranges_inconsistent_before_) return {Action::kExcludeRanges, variance};
  }
  // Dopplers alone contradict an IMU in passing, reflected by walls, or again and again because the
  // IMU has failed.
  const bool passing = doppler && evidence.has_attitude && !doppler_inconsistent_before_ &&
                       !(missing_variance(Observable::kCarrier, evidence, robust_update) > 0.0);
  if (passing || is_confirmed(observable, std::sqrt(variance), evidence))
    return {Action::kExclude, variance};
  return {Action::kInflate, variance};
}

void PredictionTest::finish_epoch(const Evidence& evidence, bool suspect) {
  if (!suspect &&
      median_is_consistent(table_of(evidence.tables, Observable::kCode), suspect_ratio_))
    last_consistent_time_ = evidence.time;
}

// Signals reflected by the same wall agree with each other on a wrong position. Where codes agreed
// with an IMU's prediction until a moment ago, and all that was measured of the motion since then
// confirms it, the prediction is kept at first: for 20 s, about what it takes to pass a house or
// two, and for at most the detour of such a reflection. Against codes and Dopplers, the carriers of
// older arcs confirm it; against codes, the Dopplers too: an IMU that fails contradicts both. Three
// or four carriers must all agree to the centimetre: at a corner half of the Dopplers are reflected
// as well.
bool PredictionTest::is_confirmed(Observable observable, double error,
                                  const Evidence& evidence) const {
  constexpr double kLongest_s = 20.0;
  constexpr double kLongestDetour_m = 100.0;
  constexpr std::size_t kManyCarriers = 5;  // a change of position, one of the clock, and one more
  constexpr std::size_t kMinCarriers = 3;
  const bool model_only = observable == Observable::kCode && !evidence.has_attitude;
  if (observable == Observable::kCarrier || error > kLongestDetour_m || model_only ||
      !last_consistent_time_.is_set() ||
      seconds_between(evidence.time, last_consistent_time_) > kLongest_s)
    return false;
  const FilterState& state = evidence.state;
  ClockRemovedInnovations carriers;
  for (const ClockRemovedInnovation& carrier : table_of(evidence.tables, Observable::kCarrier)) {
    const int own = evidence.measurements[carrier.index].signal_state;
    if (state.signal_states[static_cast<std::size_t>(own - state.first_signal_state())].started <=
        last_consistent_time_)
      carriers.push_back(carrier);
  }
  if (carriers.size() >= kManyCarriers) return median_is_consistent(carriers, suspect_ratio_);
  if (carriers.size() >= kMinCarriers && all_are_consistent(carriers)) return true;
  return observable == Observable::kCode &&
         median_is_consistent(table_of(evidence.tables, Observable::kDoppler), suspect_ratio_);
}

}  // namespace leonav
