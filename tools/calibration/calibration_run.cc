#include "tools/calibration/calibration_run.h"

#include <algorithm>
#include <cmath>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"

namespace leonav {
namespace {

using namespace ekf_index;

constexpr double kRestartShare = 0.6;
// A car that brakes dips, and does not go where its body points: what is alike for seconds must not
// look like hundreds of measurements. There are enough of them.
constexpr double kLeastSlide_m_s = 0.5;
// The arm's height shows by tilting alone, and attitudes that the filter corrects look like tilts:
// on simulated drives it was wrong by so many of the filter's sigmas.
constexpr double kHeightDoubt = 3.0;
// Scale factors act along the sensor's axes, not along the body's that the filter knows, and axes
// are askew by as much: (m/s)/sqrt(s) of noise per unit of scale, which takes the weight of what
// looks like millimetres of arm per m/s^2.
constexpr double kNoisePerScale = 3.0;
constexpr double kDriving_m_s = 3.0;
constexpr double kStraight_rad_s = 0.01;
constexpr double kShortest_s = 60.0;      // of driving straight on
constexpr double kAlike_s = 20.0;         // so long a road leans alike
constexpr double kSettledHeading = 0.05;  // rad, 1 sigma

double square(double x) { return x * x; }

std::size_t place(int first, std::size_t i = 0) { return static_cast<std::size_t>(first) + i; }

}  // namespace

NavigatorConfig calibrating(NavigatorConfig config, const InstallationPrior& prior) {
  config.estimator = Estimator::kEkf;
  config.solution_rate_hz = 1.0;
  VehicleConstantsConfig& constants = config.ekf.vehicle;
  constants.wander.fill(0.0);  // nothing moves within a log
  constants.count = kMaxVehicle;
  constants.restart_share = kRestartShare;
  // An attitude that wanders at first settles late, and the constants start anew with it.
  config.alignment.settling_wander = 0.0;
  // Standing with a coarse heading and an unknown arm, a filter that is linear learns both from
  // nothing (as in simultaneous localization and mapping: Huang et al. 2010): it starts in motion.
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
  // The first heading is the course, from which the body's axes may be off.
  double& off = config.alignment.course_against_heading;
  off = std::max(off, 0.5 * prior.travel_rad);
  return config;
}

CalibrationRun::CalibrationRun(const NavigatorConfig& config, const InstallationPrior& prior)
    : prior_(prior),
      wheeled_(config.vehicle.motion.constraints.non_holonomic),
      pipeline_(config, this),
      dispatch_(&pipeline_.sequencer()) {}

void CalibrationRun::on_epoch(const EpochReport& report) {
  const Solution& now = report.solution;
  const double since_s = last_epoch_.is_set() ? seconds_between(report.time, last_epoch_) : 0.0;
  last_epoch_ = report.time;
  if (!now.has_attitude) return;
  aligned_ = true;
  const Ekf& ekf = pipeline_.gnss().ekf();
  const Eigen::Vector3d rate_b = ekf.measured_rate_b() - ekf.state().errors.gyro_bias_b;
  const bool straight = now.v_n.head<2>().norm() > kDriving_m_s &&
                        std::abs(rate_b.z()) < kStraight_rad_s &&
                        now.sigma_rpy.z() < kSettledHeading;
  if (!straight) return;
  straight_s_ += std::min(since_s, 1.0);
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(ekf.state().p_e));
  straight_.push_back({C_ne * ekf.state().q_eb.toRotationMatrix(), now.sigma_rpy.x()});
}

// A vehicle on wheels stands upright in the mean: what its travel's axes lean is the mounting's.
void CalibrationRun::judge_lean(Finding* finding) const {
  if (!wheeled_ || straight_s_ < kShortest_s) return;
  const Eigen::Matrix3d C_bv = travel_axes(pipeline_.gnss().ekf().vehicle()).C_bv;
  double sum = 0.0, squares = 0.0, sigma = 0.0;
  for (const Upright& upright : straight_) {
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
  const Ekf& ekf = pipeline_.gnss().ekf();
  const VehicleConstants& found = ekf.vehicle();
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
  judge_lean(&finding);
  return finding;
}

}  // namespace leonav
