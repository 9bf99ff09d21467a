// The measurement update of Ekf, step by step.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/ekf/clock_model.h"
#include "core/ekf/ekf.h"
#include "core/ekf/median.h"
#include "core/ekf/prediction_check.h"

namespace leonav {
namespace {

using namespace ekf_index;
using SmallTable = boost::container::static_vector<double, kMaxMeasurements>;

constexpr double kStartClockSigma = 100.0;  // m, a new base's offset: so wide that the measurements
                                            // it was started from are hardly counted twice
constexpr double kStartDriftSigma = 10.0;   // m/s, likewise
constexpr double kUnknownDrift = 300.0;     // m/s, an oscillator off by 1 ppm
constexpr double kInterSystemDriftSigma = 1.0;  // m/s, between the drifts of two bases
constexpr double kMaxJumpSigma = 100.0;         // m, widening of the clocks after a jump
constexpr double kMadToSigma = 1.4826;
constexpr double kMillisecond_m = 299'792.458;
constexpr double kMillisecondTolerance = 50.0;  // m
constexpr double kStepSigma = 10.0;             // m, of a step told by codes alone

std::size_t base_of(const MeasurementEpoch& epoch, std::size_t index) {
  return index_of(epoch.satellites[epoch.measurements[index].satellite_index].satellite.system);
}

struct Start {
  double value = 0.0;
  double sigma = 0.0;
};

// Where a clock state should start so that most innovations of its base vanish.
std::optional<Start> start_from(const FilterMeasurements& measurements,
                                const MeasurementEpoch& epoch, Observable observable,
                                std::size_t base) {
  SmallTable innovations;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.observable == observable && base_of(epoch, measurement.index) == base)
      innovations.push_back(measurement.innovation);
  }
  if (innovations.empty()) return std::nullopt;
  Start start;
  start.value = median(innovations);
  SmallTable deviations;
  for (const double innovation : innovations)
    deviations.push_back(std::abs(innovation - start.value));
  start.sigma = 3.0 * kMadToSigma * median(deviations);
  return start;
}

void shift_innovations(Observable observable, double shift, FilterMeasurements* measurements) {
  for (FilterMeasurement& measurement : *measurements)
    if (measurement.observable == observable) measurement.innovation -= shift;
}

std::array<ClockFreeTable, kObservables> clock_free_tables(const FilterMeasurements& measurements,
                                                           const EkfCovariance& covariance) {
  std::array<ClockFreeTable, kObservables> tables;
  for (std::size_t kind = 0; kind < kObservables; ++kind)
    tables[kind] = clock_free(measurements, static_cast<Observable>(kind), covariance);
  return tables;
}

const ClockFreeTable& of(const std::array<ClockFreeTable, kObservables>& tables,
                         Observable observable) {
  return tables[static_cast<std::size_t>(observable)];
}

}  // namespace

// Starts the clocks of bases that appear for the first time; true if any: the innovations change.
bool Ekf::start_clocks(const MeasurementEpoch& epoch) {
  bool started = false;
  for (std::size_t base = 0; base < kMaxTimeBases; ++base) {
    if (known_.offset[base]) continue;
    const auto code = start_from(measurements_, epoch, Observable::kCode, base);
    const auto doppler = start_from(measurements_, epoch, Observable::kDoppler, base);
    if (!code && !doppler) continue;
    if (!known_.drift[base]) {
      std::size_t other = 0;
      while (other < kMaxTimeBases && !known_.drift[other]) ++other;
      if (other < kMaxTimeBases)
        copy_clock_drift(other, base, kInterSystemDriftSigma, &clocks_, &covariance_);
      else if (doppler)
        start_clock_drift(base, clocks_.drift_m_s(static_cast<Eigen::Index>(base)) + doppler->value,
                          kStartDriftSigma + doppler->sigma, &clocks_, &covariance_);
      else
        start_clock_drift(base, 0.0, kUnknownDrift, &clocks_, &covariance_);
      known_.drift[base] = true;
      started = true;
    }
    if (code) {
      start_clock_offset(base, clocks_.offset_m(static_cast<Eigen::Index>(base)) + code->value,
                         kStartClockSigma + code->sigma, &clocks_, &covariance_);
      known_.offset[base] = true;
      started = true;
    }
  }
  return started;
}

// All ambiguities by a step of the clock that their carriers did not make. Whole milliseconds are
// taken as exact; of any other step the codes tell no more than their noise allows.
void Ekf::shift_ambiguities(double shift_m) {
  if (shift_m == 0.0 || ambiguities_.empty()) return;
  const double whole = kMillisecond_m * std::round(shift_m / kMillisecond_m);
  const bool exact = std::abs(shift_m - whole) < kMillisecondTolerance;
  for (Ambiguity& ambiguity : ambiguities_) ambiguity.value_m += exact ? whole : shift_m;
  const auto count = static_cast<Eigen::Index>(ambiguities_.size());
  if (!exact) covariance_.block(kSize, kSize, count, count).array() += std::pow(kStepSigma, 2);
}

// A clock that steps takes the carriers along, or, in some receivers, does not: then the
// ambiguities make up for it.
void Ekf::take_up_clock_jump(EkfUpdateResult* result) {
  const double jump = common_shift(measurements_, Observable::kCode, covariance_);
  if (jump == 0.0) return;
  for (std::size_t base = 0; base < kMaxTimeBases; ++base)
    if (known_.offset[base]) clocks_.offset_m(static_cast<Eigen::Index>(base)) += jump;
  // The part of the shift that was not the clock's is left to the update to find.
  const double variance = std::pow(std::min(std::abs(jump), kMaxJumpSigma), 2);
  for (std::size_t a = 0; a < kMaxTimeBases; ++a)
    for (std::size_t b = 0; b < kMaxTimeBases; ++b)
      if (known_.offset[a] && known_.offset[b])
        covariance_(kClock + static_cast<Eigen::Index>(a), kClock + static_cast<Eigen::Index>(b)) +=
            variance;
  shift_innovations(Observable::kCode, jump, &measurements_);
  const double of_carriers = common_shift(measurements_, Observable::kCarrier, covariance_);
  shift_ambiguities(of_carriers - jump);
  shift_innovations(Observable::kCarrier, of_carriers, &measurements_);
  result->clock_jump_m = jump;
}

void Ekf::check_prediction(const MeasurementEpoch& epoch, EkfUpdateResult* result) {
  take_up_clock_jump(result);
  std::array<ClockFreeTable, kObservables> tables = clock_free_tables(measurements_, covariance_);
  result->code_ratio = consistency_ratio(of(tables, Observable::kCode));
  result->doppler_ratio = consistency_ratio(of(tables, Observable::kDoppler));
  // A wider prior without weights would follow every outlier.
  if (!config_.robust.enabled) return;
  const bool contradicted_before = std::exchange(contradicted_, false);
  // Carriers first: where they agree on a move, the codes then agree with it too.
  for (const Observable observable :
       {Observable::kDoppler, Observable::kCarrier, Observable::kCode}) {
    const double variance =
        missing_variance(config_.robust, measurements_, observable, of(tables, observable),
                         covariance_, config_.prediction_suspect_ratio, &robust_update_);
    if (variance <= 0.0) continue;
    result->prediction_suspect = true;
    if (observable != Observable::kDoppler) {
      contradicted_ = true;
      // It may be the epoch that is wrong, its time stamp for one. The next one tells.
      if (!contradicted_before) return leave_out_ranges();
    }
    widen(observable, variance, &covariance_);
    // Codes that agree on another position than the carriers stand for: the ambiguities were found
    // at a wrong one.
    if (observable == Observable::kCode && !ambiguities_.empty()) {
      forget_ambiguities();
      result->ambiguities_forgotten = true;
      gather(epoch);
    }
    tables = clock_free_tables(measurements_, covariance_);
  }
  for (const Observable observable : {Observable::kCode, Observable::kCarrier})
    set_prior_ratios(of(tables, observable), &measurements_);
}

void Ekf::leave_out_ranges() {
  const auto is_range = [](const FilterMeasurement& m) {
    return m.observable != Observable::kDoppler;
  };
  for (const FilterMeasurement& m : measurements_)
    if (is_range(m)) skipped_.push_back({m.index, Reason::kOutlier});
  measurements_.erase(std::remove_if(measurements_.begin(), measurements_.end(), is_range),
                      measurements_.end());
}

void Ekf::forget_ambiguities() {
  ambiguities_.clear();
  covariance_.conservativeResize(kSize, kSize);
}

// What the update made of each measurement.
void Ekf::close(const RobustUpdateResult& update, GpsTime time, EkfUpdateResult* result) {
  result->nis = update.nis;
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
    if (measurement.ambiguity >= 0) close_carrier(measurement, time, result);
    const auto kind = static_cast<std::size_t>(measurement.observable);
    ++result->offered[kind];
    if (rejected) ++result->rejected[kind];
  }
}

EkfUpdateResult Ekf::update(const MeasurementEpoch& epoch) {
  EkfUpdateResult result;
  for (const Measurement& measurement : epoch.measurements)
    result.innovations.push_back({.reason = measurement.reason});
  if (!initialized_) return result;

  drop_ended_arcs(epoch);
  make_room(epoch);
  disturb_ambiguities(epoch);
  gather(epoch);
  if (start_clocks(epoch)) gather(epoch);
  result.arcs_without_place = arcs_without_place_;
  check_prediction(epoch, &result);
  for (const Skipped& skipped : skipped_) result.innovations[skipped.index].reason = skipped.reason;
  for (const FilterMeasurement& measurement : measurements_) {
    InnovationReport& report = result.innovations[measurement.index];
    report.innovation = measurement.innovation;
    report.innovation_variance =
        measurement.variance + predicted_variance(measurement, covariance_);
    report.test_ratio = std::abs(report.innovation) / std::sqrt(report.innovation_variance);
  }

  const RobustUpdateResult update = robust_update_(config_.robust, &measurements_, &covariance_);
  apply(update.correction);
  close(update, epoch.time, &result);
  if (!measurements_.empty()) last_update_ = epoch.time;
  return result;
}

}  // namespace leonav
