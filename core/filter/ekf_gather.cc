// From an epoch's measurements to the innovations of Ekf, and the carrier arcs' coming and going.
#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/filter/ekf.h"
#include "core/filter/state/ambiguities.h"
#include "core/filter/update/measurement_model.h"
#include "core/gnss/measurement/range_model.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Vector3d;

// A new ambiguity starts where its first carrier fits the prediction, so wide that this one use of
// the prediction does not count.
constexpr double kStartAmbiguitySigma = 100.0;  // m
constexpr double kStartShare = 10.0;            // and of the prediction's sigma
// An arc thrown out in so many epochs in a row has slipped, whatever its checks said.
constexpr int kMaxRejectedEpochs = 2;
constexpr int kMinContinuousArcs =
    5;  // arcs that go on: a position's change and a clock's, and one more
constexpr int kContinuousPerBroken = 10;
constexpr double kFrequentBreaksMemory_s = 600.0;  // so long such a receiver is expected to go on
constexpr double kNewArcs_s = 5.0;                 // whether arcs last is not known of new ones

// Variance of white noise that averages like an error of this correlation time.
double correlation_inflation(double correlation_time_s, double dt) {
  if (correlation_time_s <= 0.0 || dt <= 0.0) return 1.0;
  const double r = std::exp(-dt / correlation_time_s);
  return (1.0 + r) / (1.0 - r);
}

}  // namespace

// An arc has ended where its satellite has another one now, or has not been seen for long.
void Ekf::drop_ended_arcs(const MeasurementEpoch& epoch) {
  for (int i = static_cast<int>(state_.ambiguities.size()) - 1; i >= 0; --i) {
    const Ambiguity& ambiguity = state_.ambiguities[static_cast<std::size_t>(i)];
    bool ended = ambiguity.rejected >= kMaxRejectedEpochs ||
                 seconds_between(epoch.time, ambiguity.last_used) > config_.max_arc_gap_s;
    for (const Measurement& measurement : epoch.measurements) {
      if (measurement.observable != Observable::kCarrier || measurement.arc == ambiguity.arc)
        continue;
      const SatelliteInView& satellite = epoch.satellites[measurement.satellite_index];
      ended = ended || satellite.satellite == ambiguity.satellite;
    }
    if (ended) drop_ambiguity(i);
  }
}

void Ekf::drop_ambiguity(int index) {
  remove_ambiguity(index, &state_.ambiguities, &covariance_);
  if (process_.continuous) process_.remove(state_.first_ambiguity() + index);
}

// New arcs take the places of those unseen at this epoch, longest unseen first.
void Ekf::free_ambiguity_states(const MeasurementEpoch& epoch) {
  boost::container::static_vector<std::uint32_t, kMaxMeasurements> seen;
  std::size_t fresh = 0;
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCarrier || measurement.reason != Reason::kUsed)
      continue;
    seen.push_back(measurement.arc);
    fresh += find_ambiguity(state_.ambiguities, measurement.arc) == kNoAmbiguity ? 1 : 0;
  }
  while (state_.ambiguities.size() + fresh > state_.ambiguities.capacity()) {
    int longest = kNoAmbiguity;
    for (int i = 0; i < static_cast<int>(state_.ambiguities.size()); ++i) {
      const Ambiguity& ambiguity = state_.ambiguities[static_cast<std::size_t>(i)];
      if (std::find(seen.begin(), seen.end(), ambiguity.arc) != seen.end()) continue;
      if (longest == kNoAmbiguity ||
          ambiguity.last_used < state_.ambiguities[static_cast<std::size_t>(longest)].last_used)
        longest = i;
    }
    if (longest == kNoAmbiguity) return;
    drop_ambiguity(longest);
  }
}

// State index of the arc's ambiguity, started if need be; kNoAmbiguity: no index for another.
int Ekf::find_or_add_ambiguity(const Measurement& carrier, SatelliteId satellite,
                               const FilterMeasurement& entry, GpsTime time) {
  int index = find_ambiguity(state_.ambiguities, carrier.arc);
  if (index != kNoAmbiguity) return state_.first_ambiguity() + index;
  if (state_.ambiguities.size() == state_.ambiguities.capacity()) return kNoAmbiguity;
  Ambiguity ambiguity;
  ambiguity.arc = carrier.arc;
  ambiguity.satellite = satellite;
  ambiguity.value_m = entry.innovation;
  ambiguity.random_walk = carrier.random_walk;
  ambiguity.started = ambiguity.last_used = time;
  const double predicted = std::sqrt(std::max(predicted_variance(entry, covariance_), 0.0));
  const double sigma_m = kStartAmbiguitySigma + kStartShare * predicted;
  add_ambiguity(ambiguity, sigma_m, &state_.ambiguities, &covariance_);
  if (process_.continuous) process_.append(square(sigma_m));
  return state_.first_ambiguity() + static_cast<int>(state_.ambiguities.size()) - 1;
}

// Whether the position is known against that of the last epoch as well as carriers tell, so that
// codes of both are of one index. Where arcs end by the handful (a phone, a receiver among trees)
// it creeps, and what holds it are the codes, whose errors it then follows.
Ekf::CarrierContinuity Ekf::evaluate_carrier_continuity(const MeasurementEpoch& epoch) {
  if (config_.static_point) return CarrierContinuity::kContinuous;
  int held = 0, broken = 0;
  for (const Measurement& carrier : epoch.measurements) {
    if (carrier.observable != Observable::kCarrier || carrier.reason != Reason::kUsed ||
        carrier.satellite_index >= epoch.satellites.size())
      continue;
    const SatelliteInView& satellite = epoch.satellites[carrier.satellite_index];
    const int index = find_ambiguity(state_.ambiguities, carrier.arc);
    if (index != kNoAmbiguity) {
      held += state_.ambiguities[static_cast<std::size_t>(index)].last_used == last_update_ ? 1 : 0;
    } else {
      broken += satellite.arc_causes.any() ? 1 : 0;
    }
  }
  const auto lasts = [&epoch](GpsTime until) { return until.is_set() && epoch.time <= until; };
  if (held == 0) {
    new_arcs_until_ = epoch.time.plus_seconds(kNewArcs_s);
    code_weighting_.clear();
  } else if (held < kMinContinuousArcs || broken > std::max(1, held / kContinuousPerBroken)) {
    frequent_arc_breaks_until_ = epoch.time.plus_seconds(kFrequentBreaksMemory_s);
  }
  if (lasts(frequent_arc_breaks_until_)) return CarrierContinuity::kNone;
  return lasts(new_arcs_until_) ? CarrierContinuity::kNewArcs : CarrierContinuity::kContinuous;
}

// What a code weighs: less than its variance says, as far as it errs like the one before it.
void Ekf::weigh_code(const MeasurementEpoch& epoch, const Measurement& code,
                     double correlation_time_ratio, FilterMeasurement* entry) {
  const SatelliteInView& satellite = epoch.satellites[code.satellite_index];
  const double inflation =
      correlation_inflation(correlation_time_ratio * config_.code_correlation_time_s,
                            seconds_between(epoch.time, last_update_));
  const double correlated = square(code.correlated_sigma);
  if (carrier_continuity_ == CarrierContinuity::kNone || !(correlated > 0.0) ||
      !(code.correlation_time_s > 0.0)) {
    entry->gain_variance = inflation * entry->variance;
    return;
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
  const double scheduled = code_weighting_.weigh(code, satellite.satellite, error_model, noise,
                                                 epoch.time, &entry->code_weighting_entry);
  // Of new arcs it is not known whether they last: their codes count in full, but are remembered.
  entry->gain_variance =
      carrier_continuity_ == CarrierContinuity::kNewArcs ? inflation * entry->variance : scheduled;
}

void Ekf::assemble_measurements(const MeasurementEpoch& epoch) {
  if (assembled_epoch_ != epoch.time) {
    for (const FilterMeasurement& before : measurements_)
      if (before.factor > 0.0) code_weighting_.accept(before.code_weighting_entry);
  }
  assembled_epoch_ = epoch.time;
  carrier_continuity_ = evaluate_carrier_continuity(epoch);
  if (carrier_continuity_ == CarrierContinuity::kNone) code_weighting_.clear();
  AntennaMotion motion = antenna();
  // A prediction hundreds of metres off is too far for a straight line to reach centimetres.
  Vector3d off_e = Vector3d::Zero();
  if (!epoch.approximate_p_e.isZero()) off_e = epoch.approximate_p_e - motion.p_e;
  motion.p_e += off_e;
  const double dt = seconds_between(epoch.time, last_update_);
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
                    !known_clocks_.offset[index_of(satellite.satellite.system)])) {
      excluded_.push_back({i, Reason::kNotSolved});
      continue;
    }
    const MeasurementPrediction prediction = predict_measurement(
        measurement, satellite, motion, state_.clocks, state_.wet_delay_m, state_.carrier_clock_m);
    FilterMeasurement entry;
    entry.index = i;
    entry.observable = measurement.observable;
    entry.innovation =
        measurement.value - prediction.value + prediction.row.segment<3>(kPosition).dot(off_e);
    entry.variance = square(measurement.sigma);
    entry.gain_variance = entry.variance;
    entry.row = prediction.row;
    const double lasts = correlation_time_ratio(satellite, motion.p_e);
    if (measurement.observable == Observable::kCode) weigh_code(epoch, measurement, lasts, &entry);
    if (measurement.observable == Observable::kDoppler)
      entry.gain_variance *= correlation_inflation(lasts * config_.doppler_correlation_time_s, dt);
    if (carrier) {
      entry.ambiguity = find_or_add_ambiguity(measurement, satellite.satellite, entry, epoch.time);
      if (entry.ambiguity < 0) {
        ++arcs_without_capacity_;
        excluded_.push_back({i, Reason::kCapacity});
        continue;
      }
      const auto index = static_cast<std::size_t>(entry.ambiguity - state_.first_ambiguity());
      state_.ambiguities[index].random_walk =
          measurement.random_walk;  // its orbit may be another by now
      entry.innovation -= state_.ambiguities[index].value_m;
    }
    measurements_.push_back(entry);
  }
}

// An arc whose constant, or a position whose meaning, may have stepped since the last epoch is less
// certain for it.
void Ekf::inflate_disturbed_states(const MeasurementEpoch& epoch) {
  for (EkfCovariance* covariance : covariance_and_noise())
    covariance->diagonal().segment<3>(kPosition).array() += square(epoch.position_disturbance_m);
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCarrier || !(measurement.disturbance_m > 0.0))
      continue;
    const int index = find_ambiguity(state_.ambiguities, measurement.arc);
    if (index == kNoAmbiguity) continue;
    const int state = state_.first_ambiguity() + index;
    for (EkfCovariance* covariance : covariance_and_noise())
      (*covariance)(state, state) += square(measurement.disturbance_m);
  }
}

// What the update made of a carrier decides whether its arc goes on.
void Ekf::update_arc_rejection(const FilterMeasurement& measurement, GpsTime time,
                               EkfUpdateResult* result) {
  Ambiguity& ambiguity =
      state_
          .ambiguities[static_cast<std::size_t>(measurement.ambiguity - state_.first_ambiguity())];
  ambiguity.last_used = time;
  ambiguity.rejected = measurement.factor > 0.0 ? 0 : ambiguity.rejected + 1;
  if (ambiguity.rejected >= kMaxRejectedEpochs) result->slipped.push_back(ambiguity.satellite);
}

}  // namespace leonav
