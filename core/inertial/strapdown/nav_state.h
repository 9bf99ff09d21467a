// NavState is the nominal inertial state: position, velocity, attitude and the sensors' errors.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/base/gps_time.h"

namespace leonav {

// Sensor errors per body axis: measured = (1 + scale) true + bias.
struct ImuErrors {
  Eigen::Vector3d gyro_bias_b = Eigen::Vector3d::Zero();   // rad/s
  Eigen::Vector3d accel_bias_b = Eigen::Vector3d::Zero();  // m/s^2
  Eigen::Vector3d gyro_scale = Eigen::Vector3d::Zero();    // dimensionless
  Eigen::Vector3d accel_scale = Eigen::Vector3d::Zero();   // dimensionless
};

// State of the IMU's centre at one instant.
struct NavState {
  GpsTime time;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();             // m, IMU centre
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();             // m/s, relative to the rotating Earth
  Eigen::Quaterniond q_eb = Eigen::Quaterniond::Identity();  // body to ECEF
  ImuErrors errors;
};

}  // namespace leonav
