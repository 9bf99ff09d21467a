// NavigatorConfig is the whole configuration of the navigator, in SI units and radians.
#pragma once
#include <Eigen/Core>
#include <algorithm>

#include "core/filter/state/ekf_config.h"
#include "core/gnss/measurement/gnss_config.h"
#include "core/inertial/alignment/alignment.h"
#include "core/inertial/strapdown/imu_error_model.h"
#include "core/integrity/integrity_config.h"
#include "core/smoother/smoother_config.h"
#include "core/vehicle/motion_aiding_config.h"

namespace leonav {

// The kind of vehicle, which determines defaults (vehicle_defaults.h). Boats, UAVs and handheld
// devices have no motion constraints by default.
enum class VehicleKind : unsigned char { kCar, kRail, kBoat, kUav, kHandheld };

// The installation of the sensors in the vehicle, and the vehicle's motion constraints.
struct VehicleConfig {
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  // m, IMU centre to antenna phase centre
  // Roll, pitch and yaw (rad) of the rotation from the IMU's axes to the body frame.
  Eigen::Vector3d mounting_rpy = Eigen::Vector3d::Zero();
  VehicleKind kind = VehicleKind::kHandheld;
  MotionAidingConfig motion;

  bool operator==(const VehicleConfig&) const = default;
};

// Deadlines and expected times of arrival. All are data time, so that a replay decides the same.
struct RealtimeConfig {
  double deadline_ekf_s = 0.2;       // D_ekf, from the issue of an epoch to the filter's deadline
  double deadline_smoother_s = 0.5;  // D_smoother, the same for the smoother
  double epoch_interval_s = 1.0;     // expected interval of GNSS epochs
  // Returns the deadline that is in force for the smoother: not before the filter's.
  double smoother_deadline_s() const { return std::max(deadline_ekf_s, deadline_smoother_s); }

  // Latency of an epoch up to which no empty epoch replaces it.
  double gnss_latency_allowance_s = 0.5;

  // Returns after how long without satellites a solution is that of the IMU alone
  // (Source::kInsOnly). Two epochs in a row may be missing; the half is for times that jitter.
  double ins_only_after_s() const { return 2.5 * epoch_interval_s; }

  bool operator==(const RealtimeConfig&) const = default;
};

// The estimator that gives the solution. The filter runs in both cases.
enum class Estimator : unsigned char { kEkf, kSmoother };

// The configuration of the navigator and all its parts.
struct NavigatorConfig {
  Estimator estimator = Estimator::kEkf;
  VehicleConfig vehicle;
  MotionModel motion = MotionModel::kInertial;
  ImuErrorModel imu;
  double imu_time_offset_s = 0.0;  // is added to the IMU's stamps
  AlignmentConfig alignment;
  GnssConfig gnss;
  EkfConfig ekf;
  SmootherConfig smoother;
  IntegrityConfig integrity;
  RealtimeConfig realtime;
  double solution_rate_hz = 200.0;  // largest rate of published solutions, by data time
  double checkpoint_max_age_s = 30.0 * 86400.0;  // an older checkpoint is not used; data time

  bool operator==(const NavigatorConfig&) const = default;
};

}  // namespace leonav
