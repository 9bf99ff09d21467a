// The whole configuration of the navigator. SI units and radians; daemon/config reads it from YAML.
#pragma once
#include <Eigen/Core>

#include "core/ekf/ekf_config.h"
#include "core/gnss/gnss_config.h"
#include "core/ins/alignment.h"
#include "core/ins/imu_error_model.h"
#include "core/navigator/motion_aid.h"
#include "core/smoother/smoother_config.h"

namespace leonav {

// What moves as it likes has no constraints.
enum class VehicleKind : unsigned char { kCar, kRail, kBoat, kUav, kHandheld };

struct VehicleConfig {
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  // m, IMU centre to antenna phase centre
  Eigen::Vector3d mounting_rpy =
      Eigen::Vector3d::Zero();  // rad; rotates IMU axes into the body frame
  VehicleKind kind = VehicleKind::kHandheld;
  MotionAidConfig motion;
};

struct RealtimeConfig {
  double deadline_ekf_s = 0.2;            // D_ekf, data time
  double deadline_smoother_s = 0.5;       // D_smoother, data time
  double epoch_interval_s = 1.0;          // expected GNSS interval
  double gnss_latency_allowance_s = 0.5;  // how long after its time an epoch may come in
};

// Who gives the answer; the filter runs in both cases.
enum class Estimator : unsigned char { kEkf, kSmoother };

struct NavigatorConfig {
  Estimator estimator = Estimator::kEkf;
  VehicleConfig vehicle;
  MotionModel motion = MotionModel::kInertial;
  ImuErrorModel imu;
  double imu_time_offset_s = 0.0;  // to be added to the IMU's stamps
  AlignmentConfig alignment;
  GnssConfig gnss;
  EkfConfig ekf;
  SmootherConfig smoother;
  RealtimeConfig realtime;
  double solution_rate_hz = 200.0;               // published at most this often
  double checkpoint_max_age_s = 30.0 * 86400.0;  // data time; an older one is not begun from
};

}  // namespace leonav
