// AntennaModel predicts position and velocity of the GNSS antenna from the filter's state.
#pragma once
#include <Eigen/Core>

#include "core/filter/state/filter_state.h"
#include "core/filter/update/measurement_model.h"

namespace leonav {

// The motion of the body by the last IMU samples.
struct BodyMotion {
  // Angular rate of the last IMU sample in body axes, sensor errors not removed, rad/s: it turns
  // the lever arm.
  Eigen::Vector3d measured_rate_b = Eigen::Vector3d::Zero();
  // Acceleration of the IMU against the Earth, mean over 0.05 s, m/s^2: it moves the antenna during
  // the IMU's time offset. Zero where that offset is not estimated.
  Eigen::Vector3d acceleration_e = Eigen::Vector3d::Zero();
};

// The equations are those of antenna_motion() in core/filter/update/measurement_model.h.
class AntennaModel {
 public:
  // `lever_arm_b`: from the IMU to the antenna in body axes, m. With `vertical_arm` the antenna of
  // a filter without attitude is this lever arm's vertical part above the point that is estimated;
  // without it the point that is estimated is the antenna.
  AntennaModel(const Eigen::Vector3d& lever_arm_b, bool vertical_arm)
      : lever_arm_b_(lever_arm_b), vertical_arm_(vertical_arm) {}

  // Returns position and velocity of the antenna with their derivatives, ECEF, m and m/s.
  AntennaMotion motion(const FilterState& state, bool has_attitude, const BodyMotion& body) const;
  // Returns the vector from the estimated point at `p_e` to the antenna while there is no attitude,
  // ECEF, m.
  Eigen::Vector3d offset_without_attitude_e(const Eigen::Vector3d& p_e) const;

 private:
  Eigen::Vector3d lever_arm_b_;
  bool vertical_arm_;
};

// These return the covariance of the antenna's position (m^2) and velocity ((m/s)^2), ECEF, with
// the uncertainty of its lever arm and of the IMU's time, from that of the filter's state.
Eigen::Matrix3d antenna_position_covariance_e(const AntennaMotion& antenna, const EkfCovariance& P);
Eigen::Matrix3d antenna_velocity_covariance_e(const AntennaMotion& antenna, const EkfCovariance& P);

}  // namespace leonav
