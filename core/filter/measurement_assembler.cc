#include "core/filter/measurement_assembler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/base/square.h"
#include "core/filter/carrier_ambiguities.h"
#include "core/filter/error_model/reflection.h"
#include "core/filter/update/measurement_model.h"
#include "core/gnss/measurement/range_model.h"

namespace leonav {

using namespace ekf_index;
using Eigen::Vector3d;

namespace {
std::array<double, 200000> own_walk{};
}

void MeasurementAssembler::reset() {
  code_model_.reset();
  measurements_.clear();
}

void MeasurementAssembler::assemble(const MeasurementEpoch& epoch, AntennaMotion antenna,
                                    GpsTime last_update, StateEstimate* estimate) {
  const FilterState& state = estimate->state();
  if (epoch_time_ != epoch.time) code_model_.accept(measurements_);
  epoch_time_ = epoch.time;
  code_model_.begin_epoch(epoch, state.ambiguities, last_update);
  // A prediction hundreds of metres off is too far for a straight line to reach centimetres.
  Vector3d off_e = Vector3d::Zero();
  if (!epoch.approximate_p_e.isZero()) off_e = epoch.approximate_p_e - antenna.p_e;
  antenna.p_e += off_e;
  const double dt = seconds_between(epoch.time, last_update);
  interval_s_ = dt;
  speed_ = config_.static_point ? 0.0 : antenna.v_e.norm();
  errors_.begin_epoch(epoch);
  if (std::getenv("LEONAV_ORACLE") != nullptr) {
    for (std::size_t i = 0; i < state.ambiguities.size(); ++i) {
      const std::uint32_t arc = state.ambiguities[i].arc;
      if (arc < own_walk.size() && own_walk[arc] > 0.0)
        estimate->set_ambiguity_random_walk(static_cast<int>(state.first_ambiguity() + i),
                                            own_walk[arc]);
    }
  }
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
    const MeasurementPrediction prediction =
        predict_measurement(measurement, satellite, antenna, state.clocks, state.wet_delay_m,
                            state.carrier_clock_m, state.ionosphere_m);
    FilterMeasurement entry;
    entry.index = i;
    entry.observable = measurement.observable;
    entry.innovation =
        measurement.value - prediction.value + prediction.row.segment<3>(kPosition).dot(off_e);
    entry.row = prediction.row;
    weigh(epoch, measurement, line_of_sight_rate(satellite, antenna.p_e), dt, &entry);
    if (carrier) {
      entry.ambiguity =
          find_or_add_ambiguity(measurement, satellite.satellite, entry, epoch.time, estimate);
      if (entry.ambiguity < 0) {
        ++arcs_without_capacity_;
        excluded_.push_back({i, Reason::kCapacity});
        continue;
      }
      // The random walk comes from the orbit, which may be another by now.
      estimate->set_ambiguity_random_walk(
          entry.ambiguity,
          random_walk(epoch, measurement, line_of_sight_rate(satellite, antenna.p_e)));
      if (measurement.arc < own_walk.size()) own_walk[measurement.arc] = measurement.random_walk;
      entry.innovation -= estimate->ambiguity_of_state(entry.ambiguity).value_m;
    }
    measurements_.push_back(entry);
  }
}

// What is learned concerns noise and reflections; the errors of orbit, clock and ionosphere are
// modelled.
void MeasurementAssembler::weigh(const MeasurementEpoch& epoch, const Measurement& measurement,
                                 double line_of_sight_rate, double dt, FilterMeasurement* entry) {
  const ErrorClass of =
      errors_.class_of(measurement, epoch.satellites[measurement.satellite_index], standing());
  const double scale = errors_.sigma_scale(of);
  entry->variance = measurement.own_variance();
  if (scale != 1.0) {
    const double modelled = std::min(measurement.own_correlated_variance(), entry->variance);
    entry->variance = modelled + square(scale) * (entry->variance - modelled);
  }
  CorrelationModel correlation = measurement.observable == Observable::kCarrier
                                     ? errors_.carrier_correlation(speed_)
                                     : errors_.correlation(of);
  correlation.time_s = std::min(correlation.time_s, longest_reflection_s(line_of_sight_rate));
  const double inflation = variance_inflation(correlation, dt);
  entry->gain_variance = inflation * entry->variance;
  entry->correlated_share = correlation.share;
  entry->correlation_time_s = correlation.time_s;
  if (measurement.observable == Observable::kCode)
    code_model_.weigh(epoch, measurement, inflation, correlation_time_ratio(line_of_sight_rate),
                      reflected_walk(epoch, measurement, line_of_sight_rate), entry);
}

// A signal that has lost strength may be a reflection, with a way that is as much longer as codes
// of its class are learned to be off; its carrier then drifts.
double MeasurementAssembler::reflected_walk(const MeasurementEpoch& epoch, const Measurement& code,
                                            double line_of_sight_rate) const {
  const ErrorClass of = errors_.class_of(code, epoch.satellites[code.satellite_index], standing());
  if (of.loss == 0) return 0.0;
  const double scale = errors_.sigma_scale(of);
  const double noise = std::max(code.own_variance() - code.own_correlated_variance(), 0.0);
  return reflected_random_walk(std::sqrt((square(scale) - 1.0) * noise), line_of_sight_rate,
                               errors_.correlation(of).time_s);
}

double MeasurementAssembler::random_walk(const MeasurementEpoch& epoch, const Measurement& carrier,
                                         double line_of_sight_rate) const {
  const auto code = std::find_if(epoch.measurements.begin(), epoch.measurements.end(),
                                 [&](const Measurement& measurement) {
                                   return measurement.observable == Observable::kCode &&
                                          measurement.satellite_index == carrier.satellite_index;
                                 });
  if (code == epoch.measurements.end()) return carrier.random_walk;
  return std::hypot(carrier.random_walk, reflected_walk(epoch, *code, line_of_sight_rate));
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
