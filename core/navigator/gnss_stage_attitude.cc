// How GnssStage comes by an attitude: aligned, or told its heading.
#include <cmath>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/navigator/epoch_report.h"
#include "core/navigator/gnss_stage.h"
#include "core/navigator/solution.h"

namespace leonav {

// A given heading that has been used is good again only while nothing has moved since.
void GnssStage::watch_motion(const EpochWork& work) {
  for (const ImuSample& sample : work.block)
    given_heading_.watch(sample, config_.alignment.static_gyro_rad_s);
  if (!ekf_.initialized()) return;
  given_heading_.watch(ekf_.antenna_velocity_e().norm(), velocity_sigma(),
                       config_.alignment.min_course_speed_m_s);
}

double GnssStage::velocity_sigma() const {
  const Eigen::Matrix3d covariance =
      ekf_.covariance().block<3, 3>(ekf_index::kVelocity, ekf_index::kVelocity);
  return norm_of_sigmas(covariance) / std::sqrt(3.0);
}

void GnssStage::align(const EpochWork& work) {
  const bool fresh = !work.block.empty() && work.block.back().time == work.time;
  if (!inertial_ || ekf_.has_attitude() || !fresh) return;
  const auto given = given_heading_.get();
  const auto aligned = alignment_.attitude(ekf_.antenna_position_e(), ekf_.antenna_velocity_e(),
                                           velocity_sigma(), given);
  if (!aligned) return;
  given_heading_.use();
  ekf_.set_attitude(aligned->q_eb, aligned->sigma_rpy, aligned->gyro_bias_b,
                    aligned->gyro_bias_sigma);
  events_.emit(EventKind::kAligned, aligned->gyro_bias_known ? 1 : 0, aligned->sigma_rpy.z(),
               work.time);
}

// Before alignment: good for it. Afterwards: turns the filter's attitude about the vertical;
// position, velocity, clocks and IMU errors stay as they are.
void GnssStage::set_heading(double heading, double sigma) {
  if (!inertial_) return;
  given_heading_.tell({heading, sigma});
  if (!ekf_.has_attitude()) return;
  given_heading_.use();
  const NavState state = ekf_.state();
  start_report(0, state.time, true, report_.get());
  report_state(ekf_, report_.get());
  Eigen::Vector3d sigma_rpy = report_->solution.sigma_rpy;
  sigma_rpy.z() = sigma;
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(state.p_e));
  EulerAngles euler = euler_from_rotation(C_ne * state.q_eb.toRotationMatrix());
  euler.yaw = wrap_to_pi(heading);
  const Eigen::Matrix3d C_eb = C_ne.transpose() * rotation_from_euler(euler);
  ekf_.turn_attitude(Eigen::Quaterniond(C_eb).normalized(), sigma_rpy);
  events_.emit(EventKind::kAligned, 1, sigma, state.time);
}

}  // namespace leonav
