// The NavigatorConfig is the whole configuration of the navigator, in SI units and radians.
#pragma once
#include <Eigen/Core>

#include "core/filter/state/ekf_config.h"
#include "core/gnss/measurement/gnss_config.h"
#include "core/inertial/alignment/alignment.h"
#include "core/inertial/strapdown/imu_error_model.h"
#include "core/smoother/smoother_config.h"
#include "core/vehicle/motion_aiding_config.h"

namespace leonav {

// What moves as it likes has no constraints.
enum class VehicleKind : unsigned char { kCar, kRail, kBoat, kUav, kHandheld };

struct VehicleConfig {
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  // m, IMU centre to antenna phase centre
  Eigen::Vector3d mounting_rpy =
      Eigen::Vector3d::Zero();  // rad; rotates IMU axes into the body frame
  VehicleKind kind = VehicleKind::kHandheld;
  MotionAidingConfig motion;

  bool operator==(const VehicleConfig&) const = default;
};

struct RealtimeConfig {
  double deadline_ekf_s = 0.2;            // D_ekf, data time
  double deadline_smoother_s = 0.5;       // D_smoother, data time
  double epoch_interval_s = 1.0;          // expected GNSS interval
  double gnss_latency_allowance_s = 0.5;  // how long after its time an epoch may come in

  bool operator==(const RealtimeConfig&) const = default;
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

  bool operator==(const NavigatorConfig&) const = default;
};

}  // namespace leonav
