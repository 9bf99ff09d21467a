// The measurement update of Ekf, step by step.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/filter/ekf.h"
#include "core/filter/innovation_tests/clock_steps.h"
#include "core/filter/innovation_tests/prediction_consistency.h"

namespace leonav {
namespace {

using namespace ekf_index;

std::array<ClockRemovedInnovations, kObservables> clock_removed_by_observable(
    const FilterMeasurements& measurements, const EkfCovariance& covariance) {
  std::array<ClockRemovedInnovations, kObservables> tables;
  for (std::size_t kind = 0; kind < kObservables; ++kind)
    tables[kind] =
        clock_removed_innovations(measurements, static_cast<Observable>(kind), covariance);
  return tables;
}

const ClockRemovedInnovations& of(const std::array<ClockRemovedInnovations, kObservables>& tables,
                                  Observable observable) {
  return tables[static_cast<std::size_t>(observable)];
}

// From a correction of the antenna's position and velocity to one of the state's own.
EkfCorrection of_state(const EkfCorrection& of_antenna, const AntennaMotion& antenna) {
  EkfCorrection correction = of_antenna;
  if (!antenna.estimated) return correction;
  const AntennaVector constants = of_antenna.segment<kAntennaConstants>(kSize + kLeverArm);
  correction.segment<3>(kPosition) -= antenna.d_p_d_constants * constants;
  correction.segment<3>(kVelocity) -= antenna.d_v_d_constants * constants;
  return correction;
}

}  // namespace

template <typename Which>
void Ekf::exclude_if(Which which) {
  for (const FilterMeasurement& m : measurements_)
    if (which(m)) excluded_.push_back({m.index, Reason::kOutlier});
  measurements_.erase(std::remove_if(measurements_.begin(), measurements_.end(), which),
                      measurements_.end());
}

void Ekf::test_prediction(const MeasurementEpoch& epoch, EkfUpdateResult* result) {
  compensate_clock_steps(epoch, result);
  std::array<ClockRemovedInnovations, kObservables> tables =
      clock_removed_by_observable(measurements_, covariance_);
  result->code_ratio = consistency_ratio(of(tables, Observable::kCode));
  result->doppler_ratio = consistency_ratio(of(tables, Observable::kDoppler));
  // A wider prior without weights would follow every outlier.
  if (!config_.robust.enabled) return;
  const bool contradicted_before = std::exchange(ranges_inconsistent_, false);
  const bool doppler_contradicted_before = std::exchange(doppler_inconsistent_, false);
  const double suspect = config_.prediction_suspect_ratio;
  // Carriers first: where they agree on a move, the codes then agree with it too. Dopplers alone
  // contradict an IMU in passing, by way of walls, or again and again because it has failed.
  const auto missing = [&](Observable observable) {
    return unmodelled_prior_variance(config_.robust, measurements_, observable,
                                     of(tables, observable), covariance_, suspect, &robust_update_);
  };
  bool doppler_left_out = false;
  for (const Observable observable :
       {Observable::kDoppler, Observable::kCarrier, Observable::kCode}) {
    const double variance = missing(observable);
    if (variance <= 0.0) continue;
    result->prediction_suspect = true;
    if (observable != Observable::kDoppler) {
      ranges_inconsistent_ = true;
      // It may be the epoch that is wrong, its time stamp for one. The next one tells.
      if (!contradicted_before) return exclude_ranges();
    }
    const bool doppler = observable == Observable::kDoppler;
    doppler_inconsistent_ |= doppler;
    const bool passing = doppler && has_attitude_ && !doppler_contradicted_before &&
                         !(missing(Observable::kCarrier) > 0.0);
    if (passing || prediction_is_confirmed(observable, std::sqrt(variance), tables, epoch.time)) {
      doppler_left_out |= doppler;
      exclude_if([&](const FilterMeasurement& m) { return m.observable == observable; });
      tables = clock_removed_by_observable(measurements_, covariance_);
      continue;
    }
    const EkfCorrection before = covariance_.diagonal();
    inflate_covariance(observable, variance, seconds_between(epoch.time, last_update_),
                       &covariance_);
    if (process_.continuous) process_.noise.diagonal() += covariance_.diagonal() - before;
    // Codes that agree on another position than the carriers stand for: the ambiguities were found
    // at a wrong one.
    if (observable == Observable::kCode && !state_.ambiguities.empty()) {
      reset_ambiguities();
      result->ambiguities_reset = true;
      assemble_measurements(epoch);
      if (doppler_left_out)
        exclude_if([](const FilterMeasurement& m) { return m.observable == Observable::kDoppler; });
    }
    tables = clock_removed_by_observable(measurements_, covariance_);
  }
  if (!result->prediction_suspect && median_is_consistent(of(tables, Observable::kCode), suspect))
    last_consistent_time_ = epoch.time;
  for (const Observable observable : {Observable::kCode, Observable::kCarrier})
    set_prior_ratios(of(tables, observable), &measurements_);
}

// Signals that come by way of the same wall agree among each other on a wrong position. Where codes
// agreed with an IMU's prediction until a moment ago, and all that has been measured of the motion
// since confirms it, they are not believed at once: not for 20 s, about what it takes to pass a
// house or two, and by no more than such a way is longer. What confirms it are carriers of arcs
// from before, against codes and Dopplers, or Dopplers, against codes: an IMU that fails
// contradicts both. Three or four carriers must all have moved to the centimetre as it says: beside
// a corner half of the Dopplers come by way of walls as well.
bool Ekf::prediction_is_confirmed(Observable observable, double off,
                                  const std::array<ClockRemovedInnovations, kObservables>& tables,
                                  GpsTime time) const {
  constexpr double kLongest_s = 20.0;
  constexpr double kLongestDetour_m = 100.0;
  constexpr std::size_t kManyCarriers = 5;  // a move, a clock's, and one more
  constexpr std::size_t kMinCarriers = 3;
  const bool model_only = observable == Observable::kCode && !has_attitude_;
  if (observable == Observable::kCarrier || off > kLongestDetour_m || model_only ||
      !last_consistent_time_.is_set() || seconds_between(time, last_consistent_time_) > kLongest_s)
    return false;
  ClockRemovedInnovations carriers;
  for (const ClockRemovedInnovation& carrier : of(tables, Observable::kCarrier)) {
    const int state = measurements_[carrier.index].ambiguity;
    if (state_.ambiguities[static_cast<std::size_t>(state - state_.first_ambiguity())].started <=
        last_consistent_time_)
      carriers.push_back(carrier);
  }
  const double suspect = config_.prediction_suspect_ratio;
  if (carriers.size() >= kManyCarriers) return median_is_consistent(carriers, suspect);
  if (carriers.size() >= kMinCarriers && all_are_consistent(carriers)) return true;
  return observable == Observable::kCode &&
         median_is_consistent(of(tables, Observable::kDoppler), suspect);
}

void Ekf::exclude_ranges() {
  exclude_if([](const FilterMeasurement& m) { return m.observable != Observable::kDoppler; });
}

void Ekf::reset_ambiguities() {
  while (!state_.ambiguities.empty())
    drop_ambiguity(static_cast<int>(state_.ambiguities.size()) - 1);
  code_weighting_.clear();
}

// What the update made of each measurement.
void Ekf::report_innovations(const RobustUpdateResult& update, const MeasurementEpoch& epoch,
                             EkfUpdateResult* result) {
  result->nis = update.nis;
  std::array<int, kMaxTimeBases> offered{}, accepted{};  // codes
  for (const FilterMeasurement& measurement : measurements_) {
    InnovationReport& report = result->innovations[measurement.index];
    report.weight_factor = measurement.factor;
    report.residual = measurement.innovation -
                      measurement.row.dot(update.correction.head<kSize>()) -
                      (measurement.ambiguity >= 0 ? update.correction(measurement.ambiguity) : 0.0);
    if (measurement.factor <= 0.0)
      report.reason = Reason::kOutlier;
    else if (measurement.factor < 1.0)
      report.reason = Reason::kDownweighted;
    if (measurement.factor > 0.0) ++result->used;
    // Without weights nothing is thrown out, but what would be still tells a lost filter.
    const bool rejected = measurement.factor <= 0.0 ||
                          (!config_.robust.enabled && !(report.test_ratio < config_.robust.k1));
    if (measurement.ambiguity >= 0) update_arc_rejection(measurement, epoch.time, result);
    const auto kind = static_cast<std::size_t>(measurement.observable);
    ++result->offered[kind];
    if (rejected) ++result->rejected[kind];
    if (measurement.observable != Observable::kCode) continue;
    const auto base = static_cast<std::size_t>(base_of(measurement, epoch));
    ++offered[base];
    accepted[base] += rejected ? 0 : 1;
  }
  count_epochs_without_accepted_code(offered, accepted);
}

EkfUpdateResult Ekf::update(const MeasurementEpoch& epoch) {
  EkfUpdateResult result;
  for (const Measurement& measurement : epoch.measurements)
    result.innovations.push_back({.reason = measurement.reason});
  if (!initialized_) return result;

  drop_ended_arcs(epoch);
  free_ambiguity_states(epoch);
  inflate_disturbed_states(epoch);
  restart_rejected_clocks();
  const AntennaMotion motion = antenna();
  apply_antenna_transform(motion, 1.0);
  assemble_measurements(epoch);
  if (start_clocks(epoch, &result)) assemble_measurements(epoch);
  result.arcs_without_capacity = arcs_without_capacity_;
  test_prediction(epoch, &result);
  for (const ExcludedMeasurement& excluded : excluded_)
    result.innovations[excluded.index].reason = excluded.reason;
  for (const FilterMeasurement& measurement : measurements_) {
    InnovationReport& report = result.innovations[measurement.index];
    report.innovation = measurement.innovation;
    report.innovation_variance =
        measurement.variance + predicted_variance(measurement, covariance_);
    report.test_ratio = std::abs(report.innovation) / std::sqrt(report.innovation_variance);
  }

  const RobustUpdateResult update = robust_update_(config_.robust, &measurements_, &covariance_);
  const EkfCorrection correction = of_state(update.correction, motion);
  apply_antenna_transform(motion, -1.0);
  if (process_.continuous) process_.transition.rightCols<1>() -= correction;
  sigma_inflation_ = update.sigma_inflation;
  add(correction, has_attitude_, &state_);
  report_innovations(update, epoch, &result);
  if (!measurements_.empty()) last_update_ = epoch.time;
  if (config_.vehicle.restart_share > 0.0 && attitude_has_converged()) inflate_vehicle_constants();
  return result;
}

}  // namespace leonav
