#include "core/filter/measurement_assembler.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/filter/carrier_ambiguities.h"
#include "core/filter/signal_errors.h"
#include "core/filter/state/signal_states.h"
#include "core/filter/update/measurement_model.h"
#include "core/gnss/measurement/range_model.h"

namespace leonav {

using namespace ekf_index;
using Eigen::Vector3d;

namespace {

constexpr double kLeastWhiteShare = 0.05;  // of an error's variance
constexpr double kLeastCorrelation =
    0.2;  // from one epoch to the next, of an error that is a state

}  // namespace

void MeasurementAssembler::reset() {
  code_model_.reset();
  measurements_.clear();
}

void MeasurementAssembler::assemble(const MeasurementEpoch& epoch, AntennaMotion antenna,
                                    GpsTime last_update, StateEstimate* estimate) {
  const FilterState& state = estimate->state();
  if (epoch_time_ != epoch.time) code_model_.accept(measurements_);
  epoch_time_ = epoch.time;
  code_model_.begin_epoch(epoch, state.signal_states, last_update);
  // A prediction hundreds of metres off is too far for a straight line to reach centimetres.
  Vector3d off_e = Vector3d::Zero();
  if (!epoch.approximate_p_e.isZero()) off_e = epoch.approximate_p_e - antenna.p_e;
  antenna.p_e += off_e;
  const double dt = seconds_between(epoch.time, last_update);
  speed_ = config_.static_point ? 0.0 : antenna.v_e.norm();
  remove_idle_signal_errors(epoch.time, estimate);
  measurements_.clear();
  excluded_.clear();
  arcs_without_capacity_ = 0;
  for (std::size_t i = 0; i < epoch.measurements.size(); ++i) {
    const Measurement& measurement = epoch.measurements[i];
    const bool carrier = measurement.observable == Observable::kCarrier;
    if (measurement.reason != Reason::kUsed) continue;
    if (measurement.satellite_index >= epoch.satellites.size() || !(measurement.sigma > 0.0) ||
        !std::isfinite(measurement.value)) {
      excluded_.push_back({i, Reason::kImplausible});
      continue;
    }
    const SatelliteInView& satellite = epoch.satellites[measurement.satellite_index];
    if (carrier && (!config_.use_carrier || measurement.arc == 0 ||
                    !estimate->known_clocks().offset[index_of(satellite.satellite.system)])) {
      excluded_.push_back({i, Reason::kNotSolved});
      continue;
    }
    const MeasurementPrediction prediction = predict_measurement(
        measurement, satellite, antenna, state.clocks, state.wet_delay_m, state.carrier_clock_m);
    FilterMeasurement entry;
    entry.index = i;
    entry.observable = measurement.observable;
    entry.innovation =
        measurement.value - prediction.value + prediction.row.segment<3>(kPosition).dot(off_e);
    entry.row = prediction.row;
    weigh(epoch, measurement, correlation_time_ratio(satellite, antenna.p_e), dt, &entry, estimate);
    if (carrier) {
      entry.signal_state =
          find_or_add_ambiguity(measurement, satellite.satellite, entry, epoch.time, estimate);
      if (entry.signal_state < 0) {
        ++arcs_without_capacity_;
        excluded_.push_back({i, Reason::kCapacity});
        continue;
      }
      // The random walk comes from the orbit, which may be another by now.
      estimate->set_ambiguity_random_walk(entry.signal_state, measurement.random_walk);
      entry.innovation -= estimate->signal_state_at(entry.signal_state).value;
    }
    measurements_.push_back(entry);
  }
}

// What is learned concerns noise and reflections; the errors of orbit, clock and ionosphere are
// modelled.
void MeasurementAssembler::weigh(const MeasurementEpoch& epoch, const Measurement& measurement,
                                 double correlation_time_ratio, double dt, FilterMeasurement* entry,
                                 StateEstimate* estimate) {
  const ErrorClass of =
      error_class(measurement, epoch.satellites[measurement.satellite_index], standing());
  const double scale = errors_.sigma_scale(of);
  entry->variance = square(measurement.sigma);
  if (scale != 1.0) {
    const double modelled = std::min(square(measurement.correlated_sigma), entry->variance);
    entry->variance = modelled + square(scale) * (entry->variance - modelled);
  }
  CorrelationModel correlation = measurement.observable == Observable::kCarrier
                                     ? errors_.carrier_correlation(speed_)
                                     : errors_.correlation(of);
  correlation.time_s *= correlation_time_ratio;
  const double inflation = variance_inflation(correlation, dt);
  entry->gain_variance = inflation * entry->variance;
  std::optional<double> lasting;
  if (measurement.observable == Observable::kCode)
    lasting = code_model_.weigh(epoch, measurement, inflation, correlation_time_ratio, entry);
  entry->marginal_variance = entry->variance;
  if (!has_error_state(epoch, measurement, correlation, dt)) return;

  const double modelled = std::min(square(measurement.correlated_sigma), entry->variance);
  const double noise = entry->variance - modelled;
  const double white = noise * std::max(correlation.white, kLeastWhiteShare);
  // Where codes are not weighed jointly, what lasts is correlated as the noise is.
  const double correlated = noise * std::min(correlation.share, 1.0 - kLeastWhiteShare) + (lasting ? 0.0 : modelled);
  const int state =
      find_or_add_signal_error(measurement, epoch.satellites[measurement.satellite_index].satellite,
                               {std::sqrt(correlated), correlation.time_s}, epoch.time, estimate);
  if (state == kNoSignalState) return;
  entry->signal_state = state;
  entry->innovation -= estimate->signal_state_at(state).value;
  static const double test_share = getenv("TS") ? atof(getenv("TS")) : 0.0;
  entry->variance = std::max(white + (lasting ? modelled : 0.0), test_share*entry->marginal_variance);
  entry->gain_variance = white + lasting.value_or(0.0);
}

// A Doppler beside a carrier says little, and an error that has ended by the next epoch is noise.
bool MeasurementAssembler::has_error_state(const MeasurementEpoch& epoch,
                                           const Measurement& measurement,
                                           const CorrelationModel& correlation, double dt) const {
  if (!errors_.learns() || measurement.observable == Observable::kCarrier ||
      !(std::exp(-dt / correlation.time_s) > kLeastCorrelation))
    return false;
  static const bool nodop = getenv("NODOP"); if (nodop && measurement.observable == Observable::kDoppler) return false;
  if (measurement.observable == Observable::kCode || !config_.use_carrier) return true;
  return std::none_of(
      epoch.measurements.begin(), epoch.measurements.end(), [&](const Measurement& other) {
        return other.observable == Observable::kCarrier && other.reason == Reason::kUsed &&
               other.satellite_index == measurement.satellite_index;
      });
}

// Of a whole error, correlated part included: what has been estimated as that part is added again,
// and its uncertainty, which predicted_variance() contains, is no longer that of the error.
void MeasurementAssembler::learn(const MeasurementEpoch& epoch, const StateEstimate& estimate) {
  if (!errors_.learns()) return;
  whole_errors_ = measurements_;
  for (FilterMeasurement& m : whole_errors_) {
    if (m.signal_state < 0 || m.observable == Observable::kCarrier) continue;
    m.innovation += estimate.signal_state_at(m.signal_state).value;
    m.variance = m.marginal_variance - estimate.covariance()(m.signal_state, m.signal_state);
  }
  for (const Observable observable : {Observable::kCode, Observable::kDoppler})
    errors_.add(epoch, measurements_,
                clock_removed_innovations(whole_errors_, observable, estimate.covariance()),
                standing());
  errors_.end_epoch(epoch.time);
}

template <typename Predicate>
void MeasurementAssembler::exclude_if(Predicate predicate) {
  for (const FilterMeasurement& m : measurements_)
    if (predicate(m)) excluded_.push_back({m.index, Reason::kOutlier});
  measurements_.erase(std::remove_if(measurements_.begin(), measurements_.end(), predicate),
                      measurements_.end());
}

void MeasurementAssembler::exclude(Observable observable) {
  exclude_if([&](const FilterMeasurement& m) { return m.observable == observable; });
}

void MeasurementAssembler::exclude_ranges() {
  exclude_if([](const FilterMeasurement& m) { return m.observable != Observable::kDoppler; });
}

}  // namespace leonav
