// Initial attitude: levelling from the specific force, heading from course over ground, from the
// Earth's rotation, or from the configuration.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "core/ins/alignment_need.h"
#include "core/ins/course_window.h"
#include "core/ins/given_heading.h"
#include "core/ins/imu.h"
#include "core/ins/imu_error_model.h"
#include "core/ins/nav_state.h"
#include "core/ins/standing_rate.h"
#include "core/ins/velocity_matching.h"

namespace leonav {

struct AlignmentConfig {
  double levelling_window_s = 1.0;       // mean specific force over this long
  double min_course_speed_m_s = 1.0;     // course over ground is heading above this speed
  double course_window_s = 3.0;          // and must agree with the gyros for this long
  double max_course_sigma = 0.35;        // rad; the heading's uncertainty must be below
  double course_against_heading = 0.03;  // rad, 1 sigma: sideslip, mounting, a swinging antenna
  double turning_arm_m =
      0.5;  // antenna to the vertical axis the body turns about: sideslip in turns
  // rad; set: no motion needed. For who drives the alignment to tell a GivenHeading, once.
  std::optional<double> initial_heading;
  double initial_heading_sigma = 0.087;  // rad
  double levelling_sigma = 0.035;        // rad, roll and pitch after levelling
  double static_gyro_rad_s = 0.05;       // mean rate below this while standing
  // rad; good gyros find north while standing, once its 1 sigma is below this; 0: never.
  double max_gyrocompass_sigma = 0.0785;
  double static_accel_m_s2 = 0.3;  // spread of the specific force below this while standing
  // A heading found in motion must stay within its sigma, and what gyros of an unknown bias drift,
  // for this long before it is taken.
  double confirming_s = 0.0;
  bool velocity_matching = false;  // see VelocityMatching
  double matching_window_s = 15.0;
  double max_matching_sigma = 0.087;  // rad; the heading's uncertainty must be below
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  // m, for the matching
  // m/s; up to this speed the vehicle may be going in reverse, which a course cannot tell: then it
  // needs the matching's word. 0: it never does.
  double max_reverse_speed_m_s = 0.0;
  // An attitude that was found, not told, wanders by so much, rad/sqrt(s), for so long: velocities
  // by way of walls have put the level off, and gravity makes of that a heading. For who drives the
  // alignment.
  double settling_wander = 0.0;
  double settling_s = 20.0;
  bool heading_watch = false;  // see HeadingWatch; for who drives the alignment
};

// Of the velocity matching that goes with it.
VelocityMatching::Config matching_config(const AlignmentConfig& config, const ImuErrorModel& imu);

struct AlignedAttitude {
  Eigen::Quaterniond q_eb = Eigen::Quaterniond::Identity();
  Eigen::Vector3d sigma_rpy = Eigen::Vector3d::Zero();  // rad: roll, pitch, yaw
  Eigen::Vector3d gyro_bias_b =
      Eigen::Vector3d::Zero();  // rad/s, zero unless a standstill gave one
  bool gyro_bias_known = false;
  double gyro_bias_sigma = 0.0;  // rad/s, per axis
};

// Follows the attitude with the heading unknown: the gyros turn it, the specific force levels it.
// When a given heading is there, or courses over ground that agreed with the gyros for
// `course_window_s` without a stop, it gives the whole attitude. Assumes that the body x axis
// points where the vehicle goes, within `course_against_heading`, or where it comes from: up to
// `max_reverse_speed_m_s` both are carried until velocity matching tells one from the other. A
// start that is steadily sideways, or in reverse where that is not reckoned with, aligns wrongly by
// the angle between, unless there has been velocity matching to contradict it.
class Alignment {
 public:
  Alignment(const AlignmentConfig& config, const ImuErrorModel& imu);
  void reset();
  // Samples in order of time. A short hole between two is bridged (core/ins/bridge.h); what went on
  // in a longer one nobody knows: everything starts anew.
  void add(const ImuSample& sample);
  bool levelled() const;

  // Attitude at the last sample added. `v_e` and `sigma_v` (m/s, per component) are the antenna's
  // velocity then; nullopt while not levelled or the course cannot be told. To be called at every
  // epoch, also while standing: an IMU at rest and one in steady motion feel the same, so only this
  // velocity can confirm a standstill and with it the gyro bias, and only several agreeing courses
  // the heading, unless it is `given`.
  std::optional<AlignedAttitude> attitude(
      const Eigen::Vector3d& p_e, const Eigen::Vector3d& v_e, double sigma_v,
      const std::optional<GivenHeading::Heading>& given = std::nullopt);

  // What has kept the last call of attitude() from one; `latitude` in rad.
  AlignmentNeed need(double latitude) const;

 private:
  // Sums over a stretch of time, from which mean and spread follow.
  struct Sums {
    double seconds = 0.0;
    Eigen::Vector3d angle = Eigen::Vector3d::Zero();     // integral of the rate, b
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // integral of the specific force, b
    double force_squared = 0.0;                          // integral of |specific force|^2
  };
  void follow(const ImuSample& sample);
  void level_at_first(const ImuSample& sample);
  void level_on(const ImuSample& sample);
  void watch_for_standstill(const ImuSample& sample);
  void confirm_standstill(double speed_3d, double sigma_v);
  struct North {
    double turn_l = 0.0, sigma = 0.0;  // rad; from l to north
  };
  std::optional<North> gyrocompass(double latitude) const;
  double seconds_to_north(double latitude) const;
  void watch_course(const Eigen::Vector3d& v_n, double sigma_v, double relative_yaw);
  struct InMotion {
    double turn_l, sigma;                          // rad; from l to north
    std::optional<VelocityMatching::Match> match;  // if that tells roll and pitch too
  };
  std::optional<InMotion> heading_in_motion(double relative_yaw);
  std::optional<InMotion> confirmed(std::optional<InMotion> found);

  AlignmentConfig config_;
  ImuErrorModel imu_;
  ImuSample last_sample_;  // as measured; interval 0: none yet
  // Body to local level, heading arbitrary.
  Eigen::Quaterniond q_lb_ = Eigen::Quaterniond::Identity();
  double levelled_for_s_ = 0.0;
  bool implausible_ = false;  // the last try to level found no gravity
  Eigen::Vector3d first_velocity_l_ = Eigen::Vector3d::Zero();  // before levelling: sum of C dv
  double first_s_ = 0.0;
  Sums window_;               // the current second
  bool still_ = false;        // the last whole window looked like a standstill
  StandingRate unconfirmed_;  // still windows since the last velocity
  StandingRate standing_;     // still windows that a velocity confirmed
  Eigen::Quaterniond standing_q_lb_ = Eigen::Quaterniond::Identity();  // the attitude then
  StandingRate here_;  // of those, since it has last moved: all of one heading
  CourseWindow courses_{config_.course_window_s};
  struct Heading {
    double time_s, relative_yaw;
  };
  std::optional<Heading> last_heading_;  // at the last epoch
  enum class Gear : unsigned char { kUnknown, kForward, kReverse };
  Gear gear_ = Gear::kUnknown;  // since it last stopped
  struct Candidate {
    double since_s, seen_s, turn_l, sigma;
    bool another;  // than the one before, which it contradicts
  };
  std::optional<Candidate> candidate_;  // found in motion and not contradicted since
  VelocityMatching matching_;
};

}  // namespace leonav
