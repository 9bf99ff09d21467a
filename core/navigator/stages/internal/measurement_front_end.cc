#include "core/navigator/stages/internal/measurement_front_end.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/filter/state/covariance_blocks.h"
#include "core/gnss/measurement/range_model.h"
#include "core/gnss/positioning/point_solution.h"
#include "core/gnss/propagation/ionosphere.h"
#include "core/navigator/interface/filter_estimate.h"

namespace leonav {
namespace {

constexpr int kMinSatellites = 4;
constexpr double kMaxPdop = 15.0;
// At a prediction with a smaller sigma, delays are correct to a centimetre.
constexpr double kMaxLinearizationSigma_m = 20.0;
constexpr double kMaxResidualRms_m = 60.0;
constexpr double kFirstBias_m = 5.0;  // size of the biases of codes, 1 sigma

// A start can compare its measurements only with each other. It therefore always excludes faults,
// even if robust weighting is off in the filter.
RobustConfig robust_start(RobustConfig config) {
  config.enabled = true;
  return config;
}

bool is_accepted(const PointSolution& point) {
  return point.status == PointStatus::kOk && point.satellites >= kMinSatellites &&
         point.pdop <= kMaxPdop && point.residual_rms_m <= kMaxResidualRms_m &&
         point.p_e.allFinite() && point.covariance_p_e.allFinite();
}

// Ranges whose orbits or clocks were found to be wrong are less certain by what lasts of that,
// which all codes of a satellite share. The line of sight turns: a carrier changes by the whole
// error for each radian, and a Doppler has the rate of this change.
void allow_for_lasting_errors(const LastingErrors& errors, MeasurementEpoch* epoch) {
  constexpr double kLasting_s = 3600.0;
  std::array<int, kMaxSatellites> codes{};
  for (const Measurement& measurement : epoch->measurements)
    if (measurement.observable == Observable::kCode && is_used(measurement.reason))
      ++codes[measurement.satellite_index];
  for (Measurement& measurement : epoch->measurements) {
    const SatelliteInView& satellite = epoch->satellites[measurement.satellite_index];
    const double sigma_m = errors.sigma_m(satellite.satellite.system);
    if (sigma_m == 0.0) continue;
    const double rate = line_of_sight_rate(satellite, epoch->approximate_p_e);  // rad/s
    switch (measurement.observable) {
      case Observable::kCode: {
        const double shared_m =
            sigma_m * std::sqrt(std::max(codes[measurement.satellite_index], 1));
        measurement.sigma = std::hypot(measurement.sigma, shared_m);
        measurement.correlated_sigma = std::hypot(measurement.correlated_sigma, shared_m);
        measurement.correlation_time_s = std::max(measurement.correlation_time_s, kLasting_s);
        break;
      }
      case Observable::kCarrier:
        measurement.random_walk = std::hypot(measurement.random_walk, sigma_m * std::sqrt(rate));
        break;
      case Observable::kDoppler:
        measurement.sigma = std::hypot(measurement.sigma, sigma_m * rate);
        break;
    }
  }
}

}  // namespace

MeasurementFrontEnd::MeasurementFrontEnd(const NavigatorConfig& config)
    : gnss_(config.gnss),
      robust_(robust_start(config.ekf.robust)),
      use_carrier_(config.ekf.use_carrier),
      inertial_(config.motion == MotionModel::kInertial),
      lever_arm_b_(config.vehicle.lever_arm_b),
      ephemeris_store_(config.gnss.ephemeris_store),
      antennas_(config.gnss.bands),
      signal_biases_(config.gnss.bands),
      carriers_(config.gnss.cycle_slips, config.gnss.bands),
      measurements_(std::make_unique<MeasurementEpoch>()),
      point_measurements_(std::make_unique<MeasurementEpoch>()) {}

void MeasurementFrontEnd::add(const PreciseStates& states) {
  for (const PreciseState& state : states) ephemeris_store_.add(state);
}

void MeasurementFrontEnd::add(const CorrectedStates& states) {
  for (const CorrectedState& state : states) ephemeris_store_.add(state);
}

// A bias that comes for the first time moves the codes of its satellite by metres. The receiver's
// delays, which are the mean of n satellites, move by an n-th of that.
void MeasurementFrontEnd::add(const SignalBiases& biases) {
  for (const SignalBias& bias : biases) {
    const bool is_new = !signal_biases_.has(bias);
    if (!signal_biases_.add(bias) || !is_new) continue;
    const auto satellites = static_cast<double>(signal_biases_.count_in_system(bias));
    code_biases_.widen(bias.satellite.system, square(kFirstBias_m / std::max(satellites, 1.0)));
  }
}

// The observations are sorted by satellite.
int MeasurementFrontEnd::compare_orbits(const RawEpoch& raw, RefusedOrbits* begun) {
  int refused = 0;
  SatelliteId last;
  for (const SignalObservation& observation : raw.observations) {
    const SatelliteId satellite = observation.satellite;
    if (satellite == last) continue;
    last = satellite;
    if (!gnss_.systems[index_of(satellite.system)].enabled) continue;
    if (ephemeris_store_.refuse_wrong_orbit(satellite, raw.time)) begun->push_back(satellite);
    if (ephemeris_store_.is_orbit_refused(satellite, raw.time)) ++refused;
  }
  return refused;
}

// What is estimated beyond the model, or contains an error of it, follows the model.
void MeasurementFrontEnd::add(const KlobucharModel& klobuchar) {
  const KlobucharModel before = ephemeris_store_.klobuchar();
  ephemeris_store_.set_klobuchar(klobuchar);
  // Before the filter starts there are point solutions only.
  const MeasurementEpoch& last =
      measurements_->approximate_p_e.isZero() ? *point_measurements_ : *measurements_;
  if (last.approximate_p_e.isZero() || !gnss_.has_atmosphere) return;
  const Geodetic antenna = to_geodetic(last.approximate_p_e);
  const double step_m = zenith_ionosphere_m(klobuchar, antenna, last.time) -
                        zenith_ionosphere_m(before, antenna, last.time);
  code_biases_.step_ionosphere_model(step_m);
  ionosphere_step_m_ += step_m;
}

IndependentSolution MeasurementFrontEnd::solve(const EpochWork& work,
                                               const Eigen::Vector3d& approximate_p_e,
                                               ReceiverCodeBiases* biases) {
  IndependentSolution solution;
  solution.point = solve_point(work.raw, ephemeris_store_, gnss_, robust_, approximate_p_e,
                               point_measurements_.get(), biases,
                               {excluded_.data(), excluded_.size()}, &signal_biases_);
  point_measurements_->index = work.index;
  solution.accepted = is_accepted(solution.point);
  solution.measurements = point_measurements_.get();
  return solution;
}

IndependentSolution MeasurementFrontEnd::solve(const EpochWork& work,
                                               const Eigen::Vector3d& approximate_p_e) {
  return solve(work, approximate_p_e, &code_biases_);
}

IndependentSolution MeasurementFrontEnd::solve_without_biases(
    const EpochWork& work, const Eigen::Vector3d& approximate_p_e) {
  return solve(work, approximate_p_e, nullptr);
}

PreprocessAids MeasurementFrontEnd::aids(const Ekf& filter) {
  PreprocessAids aids;
  aids.biases = &code_biases_;
  aids.faulty = {excluded_.data(), excluded_.size()};
  aids.antennas = &antennas_;
  aids.signal_biases = &signal_biases_;
  if (use_carrier_) aids.carriers = &carriers_;
  // Satellite caps do not apply before the alignment: one to three satellites suffice for neither a
  // start nor an alignment.
  aids.caps = !inertial_ || filter.has_attitude();
  if (filter.has_attitude()) {
    C_er_ = filter.state().q_eb.toRotationMatrix();
    aids.C_er = &C_er_;
  }
  return aids;
}

// Returns how well the antenna's motion since the last epoch is predicted. The velocity's
// covariance grows over the interval, so its value at the end bounds that of the change. The
// antenna's rotation about the IMU is as uncertain as the gyro bias.
RangeChangePrior MeasurementFrontEnd::change_prior(const Ekf& filter, bool predicted) const {
  RangeChangePrior prior;
  prior.position_covariance = last_position_covariance_;
  if (!predicted || !carriers_.last_time().is_set()) return prior;
  const double dt = seconds_between(filter.state().time, carriers_.last_time());
  prior.change_is_free = false;
  prior.change_covariance = dt * dt * filter.antenna_velocity_covariance_e();
  if (filter.has_attitude()) {
    const double rate_variance =
        filter.covariance().diagonal().segment<3>(ekf_index::kGyroBias).sum() / 3.0;
    prior.change_covariance.diagonal().array() +=
        dt * dt * lever_arm_b_.squaredNorm() * rate_variance;
  }
  return prior;
}

// Returns the position at which the measurements are corrected and linearized: the predicted one
// or, if that is too uncertain for centimetres, that of a point solution.
Eigen::Vector3d MeasurementFrontEnd::approximate_position(const EpochWork& work,
                                                          const Ekf& filter) {
  const Eigen::Vector3d predicted_p_e = filter.antenna_position_e();
  if (!use_carrier_ || position_sigma(filter) < kMaxLinearizationSigma_m) return predicted_p_e;
  const IndependentSolution solution = solve(work, predicted_p_e);
  return solution.accepted ? solution.point.p_e : predicted_p_e;
}

void MeasurementFrontEnd::measure(const EpochWork& work, const Ekf& filter) {
  const Eigen::Vector3d approximate_p_e = approximate_position(work, filter);
  preprocess(work.raw, ephemeris_store_, gnss_, approximate_p_e, measurements_.get(), aids(filter));
  measurements_->index = work.index;
  measurements_->ionosphere_step_m = std::exchange(ionosphere_step_m_, 0.0);
  allow_for_lasting_errors(filter.learned_errors().lasting(), measurements_.get());
  if (!use_carrier_) return;
  const bool predicted = approximate_p_e == filter.antenna_position_e();
  change_prior_ = change_prior(filter, predicted);
  carriers_.check_range_changes(approximate_p_e, change_prior_, measurements_.get());
}

std::optional<double> MeasurementFrontEnd::update_carrier_speed() {
  carrier_speed_.add(carriers_.antenna_change(change_prior_));
  return carrier_speed_.horizontal(measurements_->approximate_p_e);
}

void MeasurementFrontEnd::store_update(const EkfUpdateResult& result, const Ekf& filter) {
  if (!use_carrier_) return;
  carriers_.store_epoch(*measurements_, filter.antenna_position_e());
  for (const SatelliteId satellite : result.slipped)
    carriers_.end_arc(satellite, measurements_.get());
  last_position_covariance_ = position_covariance_e(filter.covariance());
}

}  // namespace leonav
