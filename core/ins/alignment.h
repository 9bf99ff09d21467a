// Initial attitude: levelling from the specific force, heading from course over ground or
// configuration.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "core/ins/imu.h"
#include "core/ins/nav_state.h"

namespace leonav {

struct AlignmentConfig {
  double levelling_window_s = 1.0;    // mean specific force over this long
  double min_course_speed_m_s = 1.0;  // course over ground is heading above this speed
  double max_course_sigma = 0.35;  // rad; course uncertainty (velocity sigma / speed) must be below
  std::optional<double> initial_heading;  // rad; set: no motion needed
  double initial_heading_sigma = 0.087;   // rad
  double levelling_sigma = 0.035;         // rad, roll and pitch after levelling
  double static_gyro_rad_s = 0.05;  // mean rate below this while standing: also gives the gyro bias
  double static_accel_m_s2 = 0.3;   // spread of the specific force below this while standing
};

struct AlignedAttitude {
  Eigen::Quaterniond q_eb = Eigen::Quaterniond::Identity();
  Eigen::Vector3d sigma_rpy = Eigen::Vector3d::Zero();  // rad: roll, pitch, yaw
  Eigen::Vector3d gyro_bias_b =
      Eigen::Vector3d::Zero();  // rad/s, zero unless a standstill gave one
  bool gyro_bias_known = false;
};

// Follows the attitude with the heading unknown: the gyros turn it, the specific force levels it.
// When a course or a configured heading is there it gives the whole attitude.
class Alignment {
 public:
  explicit Alignment(const AlignmentConfig& config);
  void reset();
  void add(const ImuSample& sample);
  bool levelled() const;

  // Attitude at the last sample added. `v_e` and `sigma_v` (m/s, per component) are the antenna's
  // velocity then; nullopt while not levelled or the course cannot be told.
  std::optional<AlignedAttitude> attitude(const Eigen::Vector3d& p_e, const Eigen::Vector3d& v_e,
                                          double sigma_v) const;

 private:
  AlignmentConfig config_;
  Eigen::Quaterniond q_lb_ =
      Eigen::Quaterniond::Identity();  // body to local level, heading arbitrary
  double levelled_for_s_ = 0.0;
  Eigen::Vector3d standing_gyro_sum_ = Eigen::Vector3d::Zero();
  double standing_s_ = 0.0;
};

}  // namespace leonav
