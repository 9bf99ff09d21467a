#include "core/navigator/stages/internal/checkpoint_from_filter.h"

#include <numbers>

#include "core/navigator/interface/filter_estimate.h"

namespace leonav {
namespace {

// m/s, 1 sigma; with a larger one the vehicle may roll unnoticed.
constexpr double kMaxStandstillVelocitySigma = 0.1;

}  // namespace

Checkpoint checkpoint_from_filter(const EpochWork& work, const Ekf& filter,
                                  const Solution& solution, const AlignmentConfig& config) {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  // rad
  double turn_s = 0.0;
  for (const ImuSample& sample : work.block) {
    turn += sample.delta_theta_b;
    turn_s += sample.interval_s();
  }
  Checkpoint checkpoint;
  checkpoint.time = work.time;
  checkpoint.standing = may_be_stationary(filter.antenna_velocity_e().norm(),
                                          velocity_sigma(filter), config.min_course_speed_m_s) &&
                        velocity_sigma(filter) < kMaxStandstillVelocitySigma &&
                        turn.norm() < config.static_gyro_rad_s * turn_s;
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
  return checkpoint;
}

}  // namespace leonav
