// How GnssStage comes by an attitude: aligned, or told its heading.
#include <cmath>
#include <utility>

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
  judge_checkpoint(work.time);
  const auto given = given_heading_.get();
  const auto aligned = alignment_.attitude(ekf_.antenna_position_e(), ekf_.antenna_velocity_e(),
                                           velocity_sigma(), given);
  if (!aligned) return;
  given_heading_.use();
  ekf_.set_attitude(aligned->q_eb, aligned->sigma_rpy, aligned->gyro_bias_b,
                    aligned->gyro_bias_sigma);
  if (!given)
    ekf_.let_attitude_wander(config_.alignment.settling_wander, config_.alignment.settling_s);
  if (config_.alignment.heading_watch) start_heading_watch();
  events_.emit(EventKind::kAligned, aligned->gyro_bias_known ? 1 : 0, aligned->sigma_rpy.z(),
               work.time);
  if (checkpoint_judge_.pending()) tell(checkpoint_judge_.not_needed(), work.time);
}

double GnssStage::gyro_bias_sigma() const {
  return std::sqrt(ekf_.covariance().diagonal().segment<3>(ekf_index::kGyroBias).maxCoeff());
}

void GnssStage::start_heading_watch() {
  heading_watch_.start(ekf_.state().errors.gyro_bias_b, gyro_bias_sigma());
}

// A heading that was wrong from the start, or has become so, is not dragged along: nothing of what
// the filter has learned with it is of use.
void GnssStage::watch_heading(const EpochWork& work) {
  if (!heading_watch_.started()) return;
  if (!ekf_.has_attitude()) return heading_watch_.stop();
  heading_watch_.add({work.block.data(), work.block.size()});
  const bool fresh = !work.block.empty() && work.block.back().time == work.time;
  if (work.empty || !fresh || !updated_) return;
  PointSolution point;
  if (!solve_beyond_doubt(work, &point)) return;

  const NavState& state = ekf_.state();
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(state.p_e));
  report_state(ekf_, report_.get());
  const HeadingWatch::Filter filter = {
      Eigen::Quaterniond(Eigen::Matrix3d(C_ne * state.q_eb.toRotationMatrix())),
      report_->solution.sigma_rpy.z(), state.errors.gyro_bias_b, gyro_bias_sigma()};
  const double sigma_v = norm_of_sigmas(point.covariance_v_e) / std::sqrt(3.0);
  const auto off = heading_watch_.add_velocity((C_ne * point.v_e).head<2>(), sigma_v, filter);
  if (!off) return;
  heading_watch_.stop();
  given_heading_.forget();
  ekf_.forget_constants();
  ekf_.initialize(work.time, point);
  carriers_.forget_position();
  alignment_.reset();
  forget_judgements();
  gnss_used_ = true;
  last_reset_time_ = work.time;
  events_.emit(EventKind::kFilterReset, static_cast<std::uint8_t>(ResetCause::kHeading), *off,
               work.time);
}

AlignmentNeed GnssStage::alignment_need() const {
  if (!inertial_ || ekf_.has_attitude()) return {};
  if (!ekf_.initialized()) return {Lacking::kPosition};
  return alignment_.need(report_->solution.latitude);
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
  if (config_.alignment.heading_watch) start_heading_watch();
  events_.emit(EventKind::kAligned, 1, sigma, state.time);
}

}  // namespace leonav
