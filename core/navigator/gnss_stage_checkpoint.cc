// How GnssStage begins from an earlier run's checkpoint, and what it leaves for the next.
#include <cmath>
#include <numbers>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/navigator/gnss_stage.h"
#include "core/navigator/solution.h"

namespace leonav {
namespace {

constexpr double kSureToStand = 0.1;  // m/s, 1 sigma; a vaguer velocity may hide that it rolls

}  // namespace

void GnssStage::take_checkpoint(const Checkpoint& checkpoint) {
  if (!inertial_) return;
  checkpoint_judge_.take(checkpoint);
  if (ekf_.has_attitude()) tell(checkpoint_judge_.not_needed(), last_epoch_time_);
}

// Only once the attitude follows at once: what is given must not wait, unwatched. Who has told a
// heading on purpose knows better.
void GnssStage::judge_checkpoint(GpsTime time) {
  if (!checkpoint_judge_.pending() || !alignment_.levelled()) return;
  if (given_heading_.get()) return tell(checkpoint_judge_.not_needed(), time);
  const auto verdict =
      checkpoint_judge_.judge({time, ekf_.antenna_position_e(), position_sigma(),
                               ekf_.antenna_velocity_e().norm(), velocity_sigma()});
  if (!verdict) return;
  if (verdict->use == CheckpointUse::kUsed) given_heading_.tell(verdict->heading);
  tell(*verdict, time);
}

void GnssStage::tell(const CheckpointJudge::Verdict& verdict, GpsTime time) {
  events_.emit(EventKind::kCheckpoint, static_cast<std::uint8_t>(verdict.use), verdict.value, time);
}

std::optional<Checkpoint> GnssStage::checkpoint(const EpochWork& work) const {
  if (!inertial_ || !ekf_.initialized()) return std::nullopt;
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  // rad
  double turn_s = 0.0;
  for (const ImuSample& sample : work.block) {
    turn += sample.delta_theta_b;
    turn_s += sample.interval_s();
  }
  Checkpoint checkpoint;
  checkpoint.time = work.time;
  checkpoint.standing = may_stand(ekf_.antenna_velocity_e().norm(), velocity_sigma(),
                                  config_.alignment.min_course_speed_m_s) &&
                        velocity_sigma() < kSureToStand &&
                        turn.norm() < config_.alignment.static_gyro_rad_s * turn_s;
  checkpoint.antenna_p_e = ekf_.antenna_position_e();
  checkpoint.antenna_sigma = position_sigma();
  checkpoint.heading_sigma = std::numbers::pi;
  if (!ekf_.has_attitude()) return checkpoint;
  checkpoint.heading = report_->solution.yaw;
  checkpoint.heading_sigma = report_->solution.sigma_rpy.z();
  checkpoint.gyro_bias_b = ekf_.state().errors.gyro_bias_b;
  checkpoint.gyro_bias_sigma = gyro_bias_sigma();
  return checkpoint;
}

}  // namespace leonav
