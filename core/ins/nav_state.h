// The nominal inertial state: everything an IMU sample changes or is corrected by.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/time/gps_time.h"

namespace leonav {

struct ImuErrors {
  Eigen::Vector3d gyro_bias_b = Eigen::Vector3d::Zero();   // rad/s
  Eigen::Vector3d accel_bias_b = Eigen::Vector3d::Zero();  // m/s^2
  Eigen::Vector3d gyro_scale = Eigen::Vector3d::Zero();    // 1; measured = (1 + scale) true + bias
  Eigen::Vector3d accel_scale = Eigen::Vector3d::Zero();   // 1
};

struct NavState {
  GpsTime time;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();             // m, IMU centre
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();             // m/s, relative to the rotating Earth
  Eigen::Quaterniond q_eb = Eigen::Quaterniond::Identity();  // body to ECEF
  ImuErrors errors;
};

}  // namespace leonav
