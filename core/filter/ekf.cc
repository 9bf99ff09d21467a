#include "core/filter/ekf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/filter/carrier_ambiguities.h"
#include "core/filter/innovation_tests/clock_steps.h"
#include "core/filter/innovation_tests/prediction_consistency.h"
#include "core/filter/ionosphere_delay.h"
#include "core/filter/update/fault_directions.h"
#include "core/gnss/measurement/dop.h"

namespace leonav {

using namespace ekf_index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kUsualPdop = 3.0;     // where that of an epoch is not known
constexpr double kLargestPdop = 10.0;  // of the epochs that have led to a position
// Where the codes of a start leave at most two degrees of freedom; of variance.
constexpr double kFewCodesStartFactor = 9.0;

// Returns the factor by which the variance of a start's position exceeds that of its point
// solution: the variance of Student's t distribution with the degrees of freedom that the codes of
// the solution leave. So few residuals do not show how large the codes' errors are, nor which of
// them are reflected, and these errors last for many epochs.
double start_factor(const PointSolution& point) {
  const double freedom = redundancy(point);
  return freedom > 2.0 ? freedom / (freedom - 2.0) : kFewCodesStartFactor;
}

double bounded_pdop(double pdop) {
  return pdop > 0.0 && std::isfinite(pdop) ? std::min(pdop, kLargestPdop) : kUsualPdop;
}

// 1 sigma of the attitude about north, east and down at `p_e`, rad.
Vector3d attitude_sigma_n(const Vector3d& p_e, const EkfCovariance& P) {
  const Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(p_e));
  const Matrix3d covariance = C_ne * P.block<3, 3>(kAttitude, kAttitude) * C_ne.transpose();
  return covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
}

// Returns the covariance of position (ECEF) and zenith ionosphere delay, m^2.
Eigen::Matrix4d position_and_ionosphere(const EkfCovariance& P) {
  Eigen::Matrix4d covariance;
  covariance << P.block<3, 3>(kPosition, kPosition), P.block<3, 1>(kPosition, kIonosphere),
      P.block<1, 3>(kIonosphere, kPosition), P(kIonosphere, kIonosphere);
  return covariance;
}

// Sum over the axes, m^2.
double position_variance(const EkfCovariance& P) {
  return P.diagonal().segment<3>(kPosition).sum();
}

}  // namespace

Ekf::Ekf(const EkfConfig& config, const ImuErrorModel& imu, const Vector3d& lever_arm_b)
    : config_(config),
      imu_(imu),
      antenna_model_(lever_arm_b, config.vertical_arm),
      estimate_(config),
      propagator_(config, imu),
      assembler_(config),
      arc_joiner_(config),
      clocks_(config.robust),
      prediction_test_(config.robust, config.prediction_suspect_ratio),
      errors_unknown_(config.learn_errors) {}

void Ekf::reset() {
  reset_vehicle_constants();
  initialize(GpsTime(), PointSolution());
  propagator_.reset();
  estimate_.forget_clocks();
  assembler_.forget_errors();
  arc_joiner_.forget();
  errors_unknown_ = learned_errors().learns();
  lasting_change_ = {};
  initialized_ = false;
}

void Ekf::start_errors(double code_sigma_factor, double doppler_sigma_factor, double share) {
  if (errors_unknown_ && !initialized_)
    assembler_.start_errors(code_sigma_factor, doppler_sigma_factor, share);
}

void Ekf::start_constants(const VehicleConstants& values, const VehicleConstants& variances) {
  if (!initialized_) estimate_.set_vehicle_constants(values, variances);
}

void Ekf::initialize(GpsTime time, const PointSolution& given) {
  PointSolution point = given;
  if (given.satellites > 0) {  // its sigmas are those of the configuration, and of white errors
    point.covariance_p_e *=
        start_factor(given) * square(learned_errors().mean_scale(Observable::kCode));
    point.covariance_v_e *= square(learned_errors().mean_scale(Observable::kDoppler));
    point.covariance_p_e.diagonal().array() +=
        square(bounded_pdop(point.pdop) * learned_errors().lasting().largest_sigma_m());
    lasting_change_ = {};
  }
  estimate_.initialize(time, point, antenna_model_.offset_without_attitude_e(point.p_e));
  assembler_.reset();
  arc_joiner_.reset();
  prediction_test_.reset();
  clocks_.reset();
  last_update_ = time;
  initialized_ = true;
}

void Ekf::reset_vehicle_constants() {
  estimate_.remove_vehicle_constants();
  attitude_convergence_.reset();
}

void Ekf::set_attitude(const Eigen::Quaterniond& q_eb, const Vector3d& sigma_rpy,
                       const Vector3d& gyro_bias_b, double gyro_bias_sigma) {
  ImuErrors errors;
  errors.gyro_bias_b = gyro_bias_b;
  ImuErrorCovariance covariance = ImuErrorCovariance::Zero();
  covariance.diagonal() << Vector3d::Constant(square(gyro_bias_sigma)),
      Vector3d::Constant(square(imu_.accel_bias.sigma)),
      Vector3d::Constant(square(imu_.gyro_scale.sigma)),
      Vector3d::Constant(square(imu_.accel_scale.sigma));
  set_attitude(q_eb, sigma_rpy, errors, covariance);
}

void Ekf::set_attitude(const Eigen::Quaterniond& q_eb, const Vector3d& sigma_rpy,
                       const ImuErrors& errors, const ImuErrorCovariance& covariance) {
  estimate_.set_attitude(q_eb, sigma_rpy, errors, covariance, antenna_model_, propagator_.body());
  prediction_test_.forget_consistency();
}

void Ekf::replace_attitude(const Eigen::Quaterniond& q_eb, const Vector3d& sigma_rpy) {
  if (!has_attitude()) return;
  estimate_.replace_attitude(q_eb, sigma_rpy, antenna_model_, propagator_.body());
  prediction_test_.forget_consistency();
}

void Ekf::forget_attitude() {
  if (!has_attitude()) return;
  estimate_.forget_attitude(antenna_model_, propagator_.body());
  prediction_test_.forget_consistency();
}

void Ekf::replace_motion(const NavState& nav, const InertialCovariance& covariance,
                         const AttitudeRandomWalk& random_walk) {
  estimate_.replace_motion(nav, covariance, random_walk);
  restart_clock_offsets();
  prediction_test_.forget_consistency();
}

void Ekf::raise_attitude_noise(double noise, double seconds) {
  estimate_.raise_attitude_noise(noise, seconds);
}

void Ekf::predict(std::span<const ImuSample> block, GpsTime time, SpeedHistory* speeds) {
  if (!initialized_) return propagator_.remember(block);
  const bool uninterrupted = propagator_.predict(block, time, &estimate_, speeds);
  if (!uninterrupted) prediction_test_.forget_consistency();
}

MotionComponents Ekf::constrain(MotionMeasurements* measurements, double gate) {
  if (!initialized_ || !has_attitude()) return 0;
  return estimate_.constrain(measurements, gate);
}

EkfUpdateResult Ekf::update(const MeasurementEpoch& epoch) {
  EkfUpdateResult result;
  for (const Measurement& measurement : epoch.measurements)
    result.innovations.push_back({.reason = measurement.reason});
  if (!initialized_) return result;

  allow_for_lasting_errors(epoch);
  remove_ended_arcs(epoch, config_.max_arc_gap_s, arc_joiner_, &estimate_);
  result.arcs_joined = arc_joiner_.join(&estimate_);
  make_room_for_new_arcs(epoch, &estimate_);
  inflate_disturbed_states(epoch, &estimate_);
  update_ionosphere(epoch, &estimate_);
  clocks_.restart_rejected(&estimate_);

  const AntennaMotion antenna = this->antenna();
  estimate_.to_antenna_parametrization(antenna);
  assembler_.assemble(epoch, antenna, last_update_, &estimate_);
  ClockSteps steps;
  if (clocks_.start(epoch, assembler_.measurements(), &estimate_, &steps))
    assembler_.assemble(epoch, antenna, last_update_, &estimate_);
  if (errors_unknown_ && fit_first_errors(epoch))
    assembler_.assemble(epoch, antenna, last_update_, &estimate_);
  errors_unknown_ = false;
  result.arcs_without_capacity = assembler_.arcs_without_capacity();
  clocks_.compensate_steps(epoch, &robust_update_, assembler_.mutable_measurements(), &estimate_,
                           &steps);
  result.clock_jump_m = steps.clock_jump_m;
  result.code_step_m = steps.code_step_m;
  result.inter_system_step_m = steps.inter_system_step_m;
  test_prediction(epoch, antenna, &result);
  report_innovations(&result);

  const double before = position_variance(covariance());
  const RobustUpdateResult update = estimate_.correct(
      config_.robust, antenna, assembler_.mutable_measurements(), &robust_update_);
  assembler_.add_update(before, position_variance(covariance()));
  sigma_inflation_ = update.sigma_inflation;
  report_update(update, epoch, &result);
  arc_joiner_.observe(epoch, measurements(), learned_errors(), assembler_.standing(),
                      filter_state());
  if (!measurements().empty()) last_update_ = epoch.time;
  const double share = config_.vehicle.restart_share;
  if (share > 0.0 && has_attitude() &&
      attitude_convergence_.advance(attitude_sigma_n(state().p_e, covariance()), share))
    estimate_.restart_vehicle_constants(this->antenna());
  return result;
}

bool Ekf::fit_first_errors(const MeasurementEpoch& epoch) {
  const auto scales = [this] {
    return std::array{learned_errors().mean_scale(Observable::kCode),
                      learned_errors().mean_scale(Observable::kDoppler)};
  };
  const auto before = scales();
  const InnovationTables tables =
      clock_removed_by_observable(assembler_.measurements(), covariance());
  bool fitted = assembler_.fit_first_errors(epoch, table_of(tables, Observable::kCode));
  fitted |= assembler_.fit_first_errors(epoch, table_of(tables, Observable::kDoppler));
  const auto after = scales();
  if (fitted) estimate_.scale_sigmas(after[0] / before[0], after[1] / before[1]);
  return fitted;
}

void Ekf::test_prediction(const MeasurementEpoch& epoch, const AntennaMotion& antenna,
                          EkfUpdateResult* result) {
  using Action = PredictionVerdict::Action;
  FilterMeasurements& measurements = *assembler_.mutable_measurements();
  InnovationTables tables = clock_removed_by_observable(measurements, covariance());
  result->code_ratio = consistency_ratio(table_of(tables, Observable::kCode));
  result->doppler_ratio = consistency_ratio(table_of(tables, Observable::kDoppler));
  // An inflated prior without weights would follow every outlier.
  if (!config_.robust.enabled) return;

  const PredictionTest::Evidence evidence = {measurements, tables,         filter_state(),
                                             covariance(), has_attitude(), epoch.time};
  prediction_test_.begin_epoch();
  bool doppler_excluded = false;
  for (const Observable observable :
       {Observable::kDoppler, Observable::kCarrier, Observable::kCode}) {
    const PredictionVerdict verdict =
        prediction_test_.evaluate(observable, evidence, &robust_update_);
    if (verdict.action == Action::kUse) continue;
    result->prediction_suspect = true;
    if (verdict.action == Action::kExcludeRanges) return assembler_.exclude_ranges();
    if (verdict.action == Action::kExclude) {
      assembler_.exclude(observable);
      doppler_excluded |= observable == Observable::kDoppler;
    } else {
      result->prediction_widened[static_cast<std::size_t>(observable)] =
          std::sqrt(verdict.variance);
      const bool assembled_anew = inflate(verdict.variance, observable, epoch, antenna);
      if (assembled_anew && doppler_excluded) assembler_.exclude(Observable::kDoppler);
    }
    tables = clock_removed_by_observable(measurements, covariance());
  }
  prediction_test_.finish_epoch(evidence, result->prediction_suspect);
  const bool agree = !result->prediction_suspect;
  assembler_.learn_codes(epoch, position_and_ionosphere(covariance()), agree);
  if (agree) assembler_.learn_dopplers(epoch, table_of(tables, Observable::kDoppler));
  assembler_.finish_learning(epoch.time, agree);
  lasting_change_ = learned_errors().lasting().change();
  result->lasting_error_found_m = lasting_change_.found_m;
  for (const Observable observable : {Observable::kCode, Observable::kCarrier})
    set_prior_ratios(table_of(tables, observable), &measurements);
}

bool Ekf::inflate(double variance, Observable observable, const MeasurementEpoch& epoch,
                  const AntennaMotion& antenna) {
  estimate_.inflate(observable, variance, seconds_between(epoch.time, last_update_));
  if (observable != Observable::kCode || filter_state().ambiguities.empty()) return false;
  remove_all_ambiguities(&estimate_);
  assembler_.forget_codes();
  assembler_.assemble(epoch, antenna, last_update_, &estimate_);
  return true;
}

void Ekf::report_innovations(EkfUpdateResult* result) const {
  for (const ExcludedMeasurement& excluded : assembler_.excluded())
    result->innovations[excluded.index].reason = excluded.reason;
  for (const FilterMeasurement& measurement : measurements()) {
    InnovationReport& report = result->innovations[measurement.index];
    report.innovation = measurement.innovation;
    report.innovation_variance =
        measurement.variance + predicted_variance(measurement, covariance());
    report.test_ratio = std::abs(report.innovation) / std::sqrt(report.innovation_variance);
  }
}

void Ekf::report_update(const RobustUpdateResult& update, const MeasurementEpoch& epoch,
                        EkfUpdateResult* result) {
  result->nis = update.nis;
  ReceiverClocks::Counts offered{}, accepted{};  // codes
  for (const FilterMeasurement& measurement : measurements()) {
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
    // Without weights nothing is excluded, but innovations too large still show a lost filter.
    const bool rejected = measurement.factor <= 0.0 ||
                          (!config_.robust.enabled && !(report.test_ratio < config_.robust.k1));
    if (measurement.ambiguity >= 0 && record_carrier(measurement, epoch.time, &estimate_))
      result->slipped.push_back(estimate_.ambiguity_of_state(measurement.ambiguity).satellite);
    const auto kind = static_cast<std::size_t>(measurement.observable);
    ++result->offered[kind];
    if (rejected) ++result->rejected[kind];
    if (measurement.observable != Observable::kCode) continue;
    const auto system = static_cast<std::size_t>(system_of(measurement, epoch));
    ++offered[system];
    accepted[system] += rejected ? 0 : 1;
  }
  clocks_.count_epochs_without_accepted_code(offered, accepted);
}

void Ekf::restart_clock_offsets() { clocks_.restart_offsets(estimate_.known_clocks()); }

void Ekf::allow_for_fault(SatelliteId satellite, double range_m, const MeasurementEpoch& epoch) {
  for (std::size_t i = 0; i < measurements().size(); ++i) {
    const FilterMeasurement& m = measurements()[i];
    const Measurement& measurement = epoch.measurements[m.index];
    if (m.observable != Observable::kCarrier ||
        epoch.satellites[measurement.satellite_index].satellite != satellite)
      continue;
    estimate_.inflate_along(range_m *
                            FaultDirections(measurements()).state(i, covariance().rows()));
    return inflate_hidden_ambiguities(range_m);
  }
}

// The measurements of this epoch allow for what was found. Those of before did not, and have led
// the position astray: by up to the PDOP along one axis.
void Ekf::allow_for_lasting_errors(const MeasurementEpoch& epoch) {
  const LastingErrors::Change change = std::exchange(lasting_change_, {});
  if (change.codes_differ) assembler_.forget_codes();
  if (!(change.growth_m > 0.0)) return;
  const double pdop = bounded_pdop(dilution_of_precision(epoch, antenna_position_e()).pdop);
  estimate_.inflate(Observable::kCode, square(pdop * change.growth_m), 0.0);
  remove_all_ambiguities(&estimate_);
}

// The carriers of this epoch say how their ambiguities have moved; those of the others may have
// moved by as much.
void Ekf::inflate_hidden_ambiguities(double sigma_m) {
  const auto first = static_cast<int>(filter_state().first_ambiguity());
  const auto count = static_cast<int>(filter_state().ambiguities.size());
  for (int state = first; state < first + count; ++state) {
    const bool seen =
        std::any_of(measurements().begin(), measurements().end(),
                    [state](const FilterMeasurement& m) { return m.ambiguity == state; });
    if (!seen) estimate_.inflate_ambiguity(state, sigma_m);
  }
}

void Ekf::estimate_constant(int constant) {
  if (initialized_) estimate_.add_vehicle_constants(constant);
}

AntennaMotion Ekf::antenna() const {
  return antenna_model_.motion(filter_state(), has_attitude(), propagator_.body());
}

Eigen::Matrix3d Ekf::antenna_position_covariance_e() const {
  return leonav::antenna_position_covariance_e(antenna(), covariance());
}

Eigen::Matrix3d Ekf::antenna_velocity_covariance_e() const {
  return leonav::antenna_velocity_covariance_e(antenna(), covariance());
}

Vector3d Ekf::vertical_antenna_offset_e() const {
  if (has_attitude()) return Vector3d::Zero();
  return antenna_model_.offset_without_attitude_e(state().p_e);
}

}  // namespace leonav
