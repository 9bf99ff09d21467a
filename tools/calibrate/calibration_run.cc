#include "tools/calibrate/calibration_run.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/filter/update/motion_constraint.h"
#include "core/smoother/batch/batch_smoother.h"
#include "tools/smooth/trajectory.h"

namespace leonav {
namespace {

using namespace ekf_index;

constexpr double kRestartShare = 0.6;
// Lower bound of the constraints' sigma. A braking car dips and does not move where its body
// points; errors that last for seconds must not count as hundreds of independent measurements.
// There are enough measurements.
constexpr double kLeastSlide_m_s = 0.5;
// Factor for the sigma of the arm's height, which only tilting shows: corrections of the attitude
// resemble tilts. On simulated drives the height was wrong by this many of its sigmas.
constexpr double kHeightDoubt = 3.0;
// Noise in (m/s)/sqrt(s) per unit of the scale factor's sigma. Scale factors act along the sensor's
// axes, not along the filter's body axes, and axes are misaligned by as much. Without this noise,
// errors would pass for millimetres of arm per m/s^2.
constexpr double kNoisePerScale = 3.0;
// Iterations of the least squares; measurements are linearized anew in each.
constexpr int kIterations = 8;
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

// Returns the index of the last keyframe that has the installation among its states; -1: none has.
int last_with_constants(const LogGraph& graph) {
  int k = graph.size() - 1;
  while (k >= 0 && (!graph.at(k).has_attitude || graph.at(k).state.vehicle.size() < kMaxVehicle))
    --k;
  return k;
}

bool has(const ActiveStates& states, int state) {
  return std::ranges::find(states.core, state) != states.core.end();
}

// Whether the installation at this keyframe is that of the keyframe before.
bool carries_constants(const LogKeyframe& keyframe) {
  return keyframe.process.exists && has(keyframe.process.rows, kSize + kLeverArm) &&
         has(keyframe.process.columns, kSize + kLeverArm);
}

// Says which part of the log the constants at `last` are of.
void take_length(const LogGraph& graph, int last, LogFinding* found) {
  int begin = last, first = last;
  while (begin > 0 && carries_constants(graph.at(begin))) --begin;
  for (int k = 0; k < last; ++k)
    if (graph.at(k).has_attitude) first = std::min(first, k);
  found->used_s = seconds_between(graph.at(last).time, graph.at(begin).time);
  found->length_s = seconds_between(graph.at(last).time, graph.at(first).time);
}

// The constants are the same at all keyframes; `covariance` is that of the core states at this one.
void take_constants(const LogKeyframe& keyframe, const Eigen::MatrixXd& covariance,
                    const InstallationPrior& prior, bool wheeled, Finding* finding) {
  const auto take = [&](Quantity quantity, int state, double prior_sigma, double doubt = 1.0) {
    const auto i = static_cast<std::size_t>(quantity);
    const auto& core = keyframe.active.core;
    const auto at = std::find(core.begin(), core.end(), kSize + state);
    if (at == core.end()) return;
    const Eigen::Index row = at - core.begin();
    finding->change[i] = keyframe.state.vehicle[place(state)];
    finding->sigma[i] = doubt * std::sqrt(std::max(0.0, covariance(row, row)));
    finding->observed[i] = finding->sigma[i] < prior.observed_share * prior_sigma;
  };
  for (int axis = 0; axis < 3; ++axis)
    take(static_cast<Quantity>(axis), kLeverArm + axis, prior.lever_arm_m,
         axis == 2 ? kHeightDoubt : 1.0);
  take(Quantity::kTimeOffset, kTimeOffset, prior.time_offset_s);
  if (!wheeled) return;
  take(Quantity::kYaw, kTravelYaw, prior.travel_rad);
  take(Quantity::kPitch, kTravelPitch, prior.travel_rad);
}

// The vehicle's lean while it drives straight on.
struct StraightDriving {
  double seconds = 0.0;
  std::vector<double> roll, sigma_roll;  // of the travel axes, rad
};

StraightDriving straight_driving(const LogGraph& graph, const BatchResult& result) {
  StraightDriving straight;
  const Trajectory trajectory(graph, result, Estimate::kSmoothed);
  for (int k = 0; k < graph.size(); ++k) {
    const LogKeyframe& keyframe = graph.at(k);
    if (!keyframe.has_attitude || keyframe.state.vehicle.size() < kMaxVehicle) continue;
    const Solution solution = trajectory.at(k);
    const NavState& nav = keyframe.state.nav;
    const double turning_rad_s = (keyframe.measured_rate_b - nav.errors.gyro_bias_b).z();
    if (solution.v_n.head<2>().norm() < kDriving_m_s || std::abs(turning_rad_s) > kStraight_rad_s ||
        solution.sigma_rpy.z() > kSettledHeading)
      continue;
    const double since_s = k > 0 ? seconds_between(keyframe.time, graph.at(k - 1).time) : 0.0;
    straight.seconds += std::min(since_s, 1.0);
    const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(nav.p_e));
    const Eigen::Matrix3d C_bv = travel_axes(keyframe.state.vehicle).C_bv;
    straight.roll.push_back(euler_from_rotation(C_ne * nav.q_eb.toRotationMatrix() * C_bv).roll);
    straight.sigma_roll.push_back(solution.sigma_rpy.x());
  }
  return straight;
}

// A vehicle on wheels stands upright in the mean, so that the mean lean of its travel axes is that
// of the mounting.
void take_lean(const StraightDriving& straight, const InstallationPrior& prior, LogFinding* found) {
  found->straight_s = straight.seconds;
  if (straight.seconds < kShortest_s) return;
  double sum = 0.0, squares = 0.0, sigma = 0.0;
  for (std::size_t i = 0; i < straight.roll.size(); ++i) {
    sum += straight.roll[i];
    squares += square(straight.roll[i]);
    sigma += straight.sigma_roll[i];
  }
  const auto count = static_cast<double>(straight.roll.size());
  const double mean = sum / count;
  const double scatter = std::max(0.0, squares / count - square(mean));
  const double roads = std::max(1.0, straight.seconds / kAlike_s);
  const auto roll = place(static_cast<int>(Quantity::kRoll));
  Finding& finding = found->finding;
  finding.change[roll] = -mean;
  finding.sigma[roll] = std::sqrt(scatter / roads + square(sigma / count) + square(prior.lean_rad));
  finding.observed[roll] = true;
}

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
    : config_(config),
      prior_(prior),
      graph_(config.vehicle.lever_arm_b),
      collector_(config_, &graph_,
                 [this](const EpochReport& report) { add_learned(report.learned_errors); }) {}

void CalibrationRun::add_learned(const LearnedSummary& errors) {
  if (!errors.learned) return;
  const double share = 1.0 / ++learned_epochs_;
  learned_.learned = true;
  move_towards(errors.code, share, &learned_.code);
  move_towards(errors.doppler, share, &learned_.doppler);
}

LogFinding CalibrationRun::solve(const std::function<void(double)>& progress) {
  BatchConfig batch;
  batch.robust.enabled = false;  // the weights are the filter's
  batch.max_iterations = kIterations;
  const auto iteration_done = [&](int iteration, double share) {
    progress((iteration + share) / batch.max_iterations);
  };
  LogFinding found;
  const int last = last_with_constants(graph_);
  if (last < 0) {
    found.fault = LogFault::kNoAttitude;
    return found;
  }
  const BatchResult result = smooth(batch, nullptr, nullptr, iteration_done, &graph_);
  if (!result.solved) {
    found.fault = LogFault::kNoSolution;
    return found;
  }
  const bool wheeled = config_.vehicle.motion.constraints.non_holonomic;
  found.converged = result.converged;
  take_length(graph_, last, &found);
  take_constants(graph_.at(last), result.last.covariance[static_cast<std::size_t>(last)], prior_,
                 wheeled, &found.finding);
  if (wheeled) take_lean(straight_driving(graph_, result), prior_, &found);
  return found;
}

}  // namespace leonav
