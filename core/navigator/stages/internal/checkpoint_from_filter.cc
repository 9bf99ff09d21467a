#include "core/navigator/stages/internal/checkpoint_from_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/navigator/interface/filter_estimate.h"

namespace leonav {
namespace {

// m/s, 1 sigma; with a larger one the vehicle may roll unnoticed.
constexpr double kMaxStandstillVelocitySigma = 0.1;

Calibration calibration_from_filter(const Ekf& filter, const NavigatorConfig& config) {
  using namespace ekf_index;
  const ImuErrors& errors = filter.state().errors;
  const auto sigmas = [&](int state) -> Eigen::Vector3d {
    return filter.covariance().diagonal().segment<3>(state).cwiseMax(0.0).cwiseSqrt();
  };
  Calibration calibration;
  calibration.mounting_rpy = config.vehicle.mounting_rpy;
  calibration.accel_bias_b = errors.accel_bias_b;
  calibration.accel_bias_sigma = sigmas(kAccelBias);
  calibration.gyro_scale = errors.gyro_scale;
  calibration.gyro_scale_sigma = sigmas(kGyroScale);
  calibration.accel_scale = errors.accel_scale;
  calibration.accel_scale_sigma = sigmas(kAccelScale);
  const VehicleConstants& constants = filter.filter_state().vehicle;
  for (int i = 0; i < static_cast<int>(constants.size()); ++i) {
    const auto at = static_cast<std::size_t>(i);
    calibration.constants[at] = constants[at];
    calibration.constant_sigmas[at] =
        std::sqrt(std::max(0.0, filter.covariance()(kSize + i, kSize + i)));
  }
  for (int i = 0; i < 3; ++i)
    calibration.constants[static_cast<std::size_t>(kLeverArm + i)] += config.vehicle.lever_arm_b[i];
  calibration.constants[kTimeOffset] += config.imu_time_offset_s;
  return calibration;
}

}  // namespace

Checkpoint checkpoint_from_filter(const EpochWork& work, const Ekf& filter,
                                  const Solution& solution, const NavigatorConfig& config) {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  // rad
  double turn_s = 0.0;
  for (const ImuSample& sample : work.block) {
    turn += sample.delta_theta_b;
    turn_s += sample.interval_s();
  }
  Checkpoint checkpoint;
  checkpoint.time = work.time;
  checkpoint.standing =
      may_be_stationary(filter.antenna_velocity_e().norm(), velocity_sigma(filter),
                        config.alignment.min_course_speed_m_s) &&
      velocity_sigma(filter) < kMaxStandstillVelocitySigma &&
      turn.norm() < config.alignment.static_gyro_rad_s * turn_s;
  checkpoint.antenna_p_e = filter.antenna_position_e();
  checkpoint.antenna_sigma = position_sigma(filter);
  checkpoint.heading_sigma = std::numbers::pi;
  const LearnedSummary learned = filter.learned_summary();
  if (learned.learned) {
    checkpoint.code_sigma_factor = learned.code.all.sigma_factor;
    checkpoint.doppler_sigma_factor = learned.doppler.all.sigma_factor;
  }
  if (!filter.has_attitude()) return checkpoint;
  checkpoint.heading = solution.yaw;
  checkpoint.heading_sigma = solution.sigma_rpy.z();
  checkpoint.gyro_bias_b = filter.state().errors.gyro_bias_b;
  checkpoint.gyro_bias_sigma = gyro_bias_sigma(filter);
  checkpoint.calibration = calibration_from_filter(filter, config);
  return checkpoint;
}

}  // namespace leonav
