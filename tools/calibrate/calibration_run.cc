#include "tools/calibrate/calibration_run.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"

namespace leonav {
namespace {

using namespace ekf_index;

constexpr double kRestartShare = 0.6;
// Lower bound of the constraints' sigma. A braking car dips and does not move where its body
// points; errors that last for seconds must not count as hundreds of independent measurements.
// There are enough measurements.
constexpr double kLeastSlide_m_s = 0.5;
// Factor for the sigma of the arm's height, which only tilting shows: corrections of the attitude
// resemble tilts. On simulated drives the height was wrong by this many of the filter's sigmas.
constexpr double kHeightDoubt = 3.0;
// Noise in (m/s)/sqrt(s) per unit of the scale factor's sigma. Scale factors act along the sensor's
// axes, not along the filter's body axes, and axes are misaligned by as much. Without this noise,
// errors would pass for millimetres of arm per m/s^2.
constexpr double kNoisePerScale = 3.0;
constexpr double kDriving_m_s = 3.0;
constexpr double kStraight_rad_s = 0.01;
constexpr double kShortest_s = 60.0;      // of driving straight ahead
constexpr double kAlike_s = 20.0;         // correlation time of a road's cross slope
constexpr double kSettledHeading = 0.05;  // rad, 1 sigma

// Moves each number by `share` of the way to `errors`; with 1/n for the n-th it is the mean.
void move_towards(const ObservableErrors& errors, double share, ObservableErrors* mean) {
  const auto move = [share](const LearnedError& to, LearnedError* of) {
    of->sigma_factor += share * (to.sigma_factor - of->sigma_factor);
    of->correlated_share += share * (to.correlated_share - of->correlated_share);
    of->correlation_time_s += share * (to.correlation_time_s - of->correlation_time_s);
  };
  move(errors.all, &mean->all);
  for (std::size_t i = 0; i < errors.classes.size(); ++i)
    move(errors.classes[i], &mean->classes[i]);
}

std::size_t place(int first, std::size_t i = 0) { return static_cast<std::size_t>(first) + i; }

}  // namespace

NavigatorConfig with_installation_states(NavigatorConfig config, const InstallationPrior& prior) {
  config.estimator = Estimator::kEkf;
  config.solution_rate_hz = 1.0;
  VehicleConstantsConfig& constants = config.ekf.vehicle;
  constants.random_walk.fill(0.0);  // the installation is constant within a log
  constants.count = kMaxVehicle;
  constants.restart_share = kRestartShare;
  // An attitude with an additional random walk at the start would converge late, and the
  // installation parameters would start anew with it.
  config.alignment.settling_random_walk = 0.0;
  // At rest with a coarse heading and an unknown arm, a linearized filter gains information from
  // nothing (as in simultaneous localization and mapping: Huang, Mourikis, Roumeliotis 2010). It
  // therefore starts in motion.
  config.alignment.max_gyrocompass_sigma = 0.0;
  config.alignment.initial_heading.reset();
  config.imu.velocity_random_walk =
      std::hypot(config.imu.velocity_random_walk, kNoisePerScale * config.imu.accel_scale.sigma);
  for (std::size_t axis = 0; axis < 3; ++axis)
    constants.sigma[place(kLeverArm, axis)] = prior.lever_arm_m;
  constants.sigma[kTimeOffset] = prior.time_offset_s;
  if (!config.vehicle.motion.constraints.non_holonomic) return config;
  MotionConstraintConfig& motion = config.vehicle.motion.constraints;
  motion.side_sigma = std::max(motion.side_sigma, kLeastSlide_m_s);
  motion.vertical_sigma = std::max(motion.vertical_sigma, kLeastSlide_m_s);
  constants.sigma[kTravelYaw] = constants.sigma[kTravelPitch] = prior.travel_rad;
  // The first heading is the course, which may differ from the body's axes.
  double& off = config.alignment.course_heading_sigma;
  off = std::max(off, 0.5 * prior.travel_rad);
  return config;
}

CalibrationRun::CalibrationRun(const NavigatorConfig& config, const InstallationPrior& prior)
    : prior_(prior),
      wheeled_(config.vehicle.motion.constraints.non_holonomic),
      navigator_(config, this),
      dispatch_(&navigator_.sequencer()) {}

void CalibrationRun::add_learned(const LearnedSummary& errors) {
  if (!errors.learned) return;
  const double share = 1.0 / ++learned_epochs_;
  learned_.learned = true;
  move_towards(errors.code, share, &learned_.code);
  move_towards(errors.doppler, share, &learned_.doppler);
}

void CalibrationRun::on_epoch(const EpochReport& report) {
  const Solution& now = report.solution;
  const double since_s = last_epoch_.is_set() ? seconds_between(report.time, last_epoch_) : 0.0;
  last_epoch_ = report.time;
  add_learned(report.learned_errors);
  if (!now.has_attitude) return;
  aligned_ = true;
  const Ekf& ekf = navigator_.gnss().ekf();
  const Eigen::Vector3d rate_b = ekf.body().measured_rate_b - ekf.state().errors.gyro_bias_b;
  const bool straight = now.v_n.head<2>().norm() > kDriving_m_s &&
                        std::abs(rate_b.z()) < kStraight_rad_s &&
                        now.sigma_rpy.z() < kSettledHeading;
  if (!straight) return;
  straight_s_ += std::min(since_s, 1.0);
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(ekf.state().p_e));
  straight_.push_back({C_ne * ekf.state().q_eb.toRotationMatrix(), now.sigma_rpy.x()});
}

// A vehicle on wheels stands upright in the mean, so that the mean lean of its travel axes is that
// of the mounting.
void CalibrationRun::estimate_lean(Finding* finding) const {
  if (!wheeled_ || straight_s_ < kShortest_s) return;
  const Eigen::Matrix3d C_bv = travel_axes(navigator_.gnss().ekf().filter_state().vehicle).C_bv;
  double sum = 0.0, squares = 0.0, sigma = 0.0;
  for (const StraightEpoch& upright : straight_) {
    const double roll = euler_from_rotation(upright.C_nb * C_bv).roll;
    sum += roll;
    squares += square(roll);
    sigma += upright.sigma_roll;
  }
  const auto count = static_cast<double>(straight_.size());
  const double mean = sum / count;
  const double scatter = std::max(0.0, squares / count - square(mean));
  const double roads = std::max(1.0, straight_s_ / kAlike_s);
  const auto roll = place(static_cast<int>(Quantity::kRoll));
  finding->change[roll] = -mean;
  finding->sigma[roll] =
      std::sqrt(scatter / roads + square(sigma / count) + square(prior_.lean_rad));
  finding->observed[roll] = true;
}

Finding CalibrationRun::finding() const {
  Finding finding;
  const Ekf& ekf = navigator_.gnss().ekf();
  const VehicleConstants& found = ekf.filter_state().vehicle;
  if (!aligned_ || found.size() < kMaxVehicle) return finding;
  const auto take = [&](Quantity quantity, int state, double prior, double doubt = 1.0) {
    const auto i = static_cast<std::size_t>(quantity);
    const Eigen::Index row = kSize + state;
    finding.change[i] = found[place(state)];
    finding.sigma[i] = doubt * std::sqrt(std::max(0.0, ekf.covariance()(row, row)));
    finding.observed[i] = finding.sigma[i] < prior_.observed_share * prior;
  };
  for (int axis = 0; axis < 3; ++axis)
    take(static_cast<Quantity>(axis), kLeverArm + axis, prior_.lever_arm_m,
         axis == 2 ? kHeightDoubt : 1.0);
  take(Quantity::kTimeOffset, kTimeOffset, prior_.time_offset_s);
  if (!wheeled_) return finding;
  take(Quantity::kYaw, kTravelYaw, prior_.travel_rad);
  take(Quantity::kPitch, kTravelPitch, prior_.travel_rad);
  estimate_lean(&finding);
  return finding;
}

}  // namespace leonav
