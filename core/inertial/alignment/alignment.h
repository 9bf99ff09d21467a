// The alignment finds the initial attitude: roll and pitch by levelling, then the heading. The
// heading comes from the configuration or a command, from velocity matching and the course over
// ground, or, at rest, from the Earth's rotation (gyrocompassing, Groves 2013, 5.6.2). Frames: b
// body (forward, right, down), l levelled with an arbitrary heading, n north, east, down, e ECEF.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "core/base/angle.h"
#include "core/inertial/alignment/alignment_need.h"
#include "core/inertial/alignment/course_window.h"
#include "core/inertial/alignment/external_heading.h"
#include "core/inertial/alignment/internal/static_gyro_mean.h"
#include "core/inertial/alignment/velocity_matching.h"
#include "core/inertial/strapdown/imu.h"
#include "core/inertial/strapdown/imu_error_model.h"
#include "core/inertial/strapdown/nav_state.h"

namespace leonav {

// Settings of the alignment, in SI units; `ImuErrorModel` supplies the sensor's errors.
struct AlignmentConfig {
  double levelling_window_s = 1.0;           // the specific force is averaged over this long
  double min_course_speed_m_s = 1.0;         // the course over ground counts above this speed
  double course_window_s = 3.0;              // courses must agree with the gyros for this long
  double max_course_sigma = 20.0 * kDegree;  // rad, 1 sigma: a heading is accepted below this
  // rad, 1 sigma: sideslip, mounting, a swinging antenna
  double course_heading_sigma = 1.72 * kDegree;
  // Distance from the antenna to the vertical axis that the body turns about, for the sideslip in
  // turns.
  double turning_arm_m = 0.5;
  // Heading, rad, that makes motion unnecessary. The owner of the alignment hands it to an
  // ExternalHeading once; the alignment itself does not read it.
  std::optional<double> initial_heading;
  double initial_heading_sigma = 5.0 * kDegree;  // rad
  double levelling_sigma = 2.0 * kDegree;        // rad, roll and pitch after levelling
  double static_gyro_rad_s = 2.9 * kDegree;      // mean rate below this while standing
  // Good gyros find north at rest once its 1 sigma is below this, rad. 0 switches this off.
  double max_gyrocompass_sigma = 4.5 * kDegree;
  double static_accel_m_s2 = 0.3;  // spread of the specific force below this while standing
  // A heading found in motion is taken only after it has stayed for this long within its sigma and
  // the drift of gyros with an unknown bias.
  double confirming_s = 0.0;
  bool velocity_matching = false;  // see VelocityMatching
  double matching_window_s = 15.0;
  double max_matching_sigma = 5.0 * kDegree;  // rad, 1 sigma: a heading is accepted below this
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  // m, for the velocity matching
  // Up to this speed, m/s, the vehicle may be going in reverse, which a course cannot distinguish
  // from going forward: velocity matching must decide. 0: the vehicle never goes in reverse.
  double max_reverse_speed_m_s = 0.0;
  // Random walk of the attitude, rad/sqrt(s), added to the gyros' noise for `settling_s` seconds
  // after an attitude that was found in motion or at rest rather than given. Velocities from
  // reflected signals have put the level off, and gravity turns a level error into a heading error
  // at the next change of speed. The owner of the alignment applies both values; the alignment does
  // not read them.
  double settling_random_walk = 0.0;
  double settling_s = 20.0;
  bool heading_watch = false;  // see HeadingMonitor; applied by the owner

  bool operator==(const AlignmentConfig&) const = default;
};

// Returns the settings of the velocity matching that belong to `config` and `imu`.
VelocityMatching::Config matching_config(const AlignmentConfig& config, const ImuErrorModel& imu);

// An initial attitude with its uncertainty, and the gyro bias if a standstill has given one.
struct AlignedAttitude {
  Eigen::Quaterniond q_eb = Eigen::Quaterniond::Identity();
  Eigen::Vector3d sigma_rpy = Eigen::Vector3d::Zero();    // rad: roll, pitch, yaw
  Eigen::Vector3d gyro_bias_b = Eigen::Vector3d::Zero();  // rad/s, zero unless known
  bool gyro_bias_known = false;
  double gyro_bias_sigma = 0.0;  // rad/s, per axis
};

// Alignment follows the attitude while the heading is unknown and returns the whole attitude once
// it can.
//
// The gyros turn the attitude and the specific force levels it. The heading is taken from the given
// one, or from courses over ground that agreed with the gyros for `course_window_s` without a stop.
// Precondition: the body x axis points where the vehicle goes, within `course_heading_sigma`, or in
// the opposite direction. Up to `max_reverse_speed_m_s` both headings are carried until velocity
// matching decides between them. A start that is steadily sideways, or in reverse while
// `max_reverse_speed_m_s` is 0, aligns wrongly by the angle in between, unless velocity matching
// contradicts it.
class Alignment {
 public:
  // `config` and `imu` are copied; the alignment starts without a level.
  Alignment(const AlignmentConfig& config, const ImuErrorModel& imu);
  // Forgets everything except the configuration.
  void reset();
  // Adds the next sample in order of time. A short gap between two samples is filled
  // (core/inertial/strapdown/imu_gap_fill.h); after a longer one the motion is unknown, and the
  // alignment starts anew.
  void add(const ImuSample& sample);
  // Returns true once roll and pitch are known.
  bool levelled() const;

  // Returns the attitude at the last sample added, or nullopt while there is no level or no
  // heading.
  //
  // `p_e` is the position (ECEF, m), `v_e` the antenna's velocity (ECEF, m/s) at that sample,
  // `sigma_v` its 1 sigma per component (m/s), `given` a heading from outside. Call it at every
  // epoch, also at rest: an IMU at rest and one in steady motion measure the same, so only this
  // velocity can confirm a standstill and with it the gyro bias, and only several agreeing courses
  // give a heading that is not `given`.
  std::optional<AlignedAttitude> attitude(
      const Eigen::Vector3d& p_e, const Eigen::Vector3d& v_e, double sigma_v,
      const std::optional<ExternalHeading::Heading>& given = std::nullopt);

  // Returns the reason why the last call of attitude() returned none; `latitude` in rad.
  AlignmentNeed need(double latitude) const;

 private:
  // Integrals over a stretch of time, for the mean and the spread.
  struct Sums {
    double seconds = 0.0;
    Eigen::Vector3d angle = Eigen::Vector3d::Zero();     // integral of the rate, b
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // integral of the specific force, b
    double force_squared = 0.0;                          // integral of |specific force|^2
  };
  void propagate(const ImuSample& sample);
  void initialize_level(const ImuSample& sample);
  void refine_level(const ImuSample& sample);
  void detect_standstill(const ImuSample& sample);
  void confirm_standstill(double speed_3d, double sigma_v);
  // North found by gyrocompassing.
  struct North {
    double turn_l = 0.0, sigma = 0.0;  // rad; from l to north, 1 sigma
  };
  std::optional<North> gyrocompass(double latitude) const;
  double seconds_to_north(double latitude) const;
  void add_course(const Eigen::Vector3d& v_n, double sigma_v, double relative_yaw);
  // A heading found in motion.
  struct MotionHeading {
    double turn_l, sigma;                          // rad; from l to north, 1 sigma
    std::optional<VelocityMatching::Match> match;  // set if roll and pitch come with it
  };
  std::optional<MotionHeading> heading_in_motion(double relative_yaw);
  std::optional<MotionHeading> confirm_over_time(std::optional<MotionHeading> found);

  AlignmentConfig config_;
  ImuErrorModel imu_;
  ImuSample last_sample_;  // as measured; interval 0: none yet
  // Body to local level, heading arbitrary.
  Eigen::Quaterniond q_lb_ = Eigen::Quaterniond::Identity();
  double levelled_for_s_ = 0.0;
  bool implausible_ = false;  // the last attempt to level found no gravity
  Eigen::Vector3d first_velocity_l_ = Eigen::Vector3d::Zero();  // before levelling: sum of C dv
  double first_s_ = 0.0;
  Sums window_;                             // the current second
  bool window_is_static_ = false;           // the last whole window looked like a standstill
  StaticGyroMean unconfirmed_static_gyro_;  // static windows since the last velocity
  StaticGyroMean static_gyro_;              // static windows that a velocity has confirmed
  Eigen::Quaterniond static_q_lb_ = Eigen::Quaterniond::Identity();  // the attitude then
  // Mean over the confirmed static windows since the last motion: all have one heading.
  StaticGyroMean static_gyro_since_move_;
  CourseWindow courses_{config_.course_window_s};
  struct Heading {
    double time_s, relative_yaw;
  };
  std::optional<Heading> last_heading_;  // at the last epoch
  enum class Gear : unsigned char { kUnknown, kForward, kReverse };
  Gear gear_ = Gear::kUnknown;  // since it last stopped
  // A heading found in motion that is not confirmed yet.
  struct Candidate {
    double since_s, seen_s, turn_l, sigma;
    bool another;  // it contradicts the candidate before it
  };
  std::optional<Candidate> candidate_;  // found in motion and not contradicted since
  VelocityMatching matching_;
};

}  // namespace leonav
