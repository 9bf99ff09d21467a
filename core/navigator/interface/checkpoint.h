// Checkpoint holds what one run leaves for the next: antenna position, heading, sizes of errors,
// and what was found out about the IMU and how it is mounted.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string_view>

#include "core/base/gps_time.h"
#include "core/filter/state/ekf_state.h"

namespace leonav {

// Errors of the IMU beside the gyros' bias, and vehicle constants; 1 sigma of each.
struct Calibration {
  // The mounting that is configured (VehicleConfig), rad: body axes are by this one.
  Eigen::Vector3d mounting_rpy = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_b = Eigen::Vector3d::Zero();  // m/s^2
  Eigen::Vector3d accel_bias_sigma = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_scale = Eigen::Vector3d::Zero();  // 1
  Eigen::Vector3d gyro_scale_sigma = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_scale = Eigen::Vector3d::Zero();  // 1
  Eigen::Vector3d accel_scale_sigma = Eigen::Vector3d::Zero();
  // In the order of ekf_index; lever arm and time offset are whole, with what is configured. Sigma
  // 0: not estimated.
  std::array<double, ekf_index::kMaxVehicle> constants{};
  std::array<double, ekf_index::kMaxVehicle> constant_sigmas{};
};

// Position and heading of the vehicle at one time, with 1 sigma. Positions are in ECEF.
struct Checkpoint {
  GpsTime time;
  // The vehicle stood still at `time`. The heading of a moving vehicle does not show how it was
  // parked later.
  bool standing = false;
  Eigen::Vector3d antenna_p_e = Eigen::Vector3d::Zero();  // m, phase centre
  double antenna_sigma = 0.0;                             // m, 3D
  double heading = 0.0;                                   // rad, clockwise from north
  double heading_sigma = 0.0;                             // rad
  Eigen::Vector3d gyro_bias_b = Eigen::Vector3d::Zero();  // rad/s
  double gyro_bias_sigma = 0.0;                           // rad/s, per axis
  // Learned factors on the configured sigmas of codes and Dopplers (LearnedErrors); 0: none.
  double code_sigma_factor = 0.0, doppler_sigma_factor = 0.0;
  std::optional<Calibration> calibration = {};  // nullopt: from an older version
};

// Largest sigma (rad) of a heading that the next run accepts. Beyond it the next run finds a better
// heading by itself.
inline constexpr double kMaxCheckpointHeadingSigma = 10.0 * std::numbers::pi / 180.0;

// The use that was made of a checkpoint: the codes of EventKind::kCheckpoint, with the value of the
// event. On the wire: append only.
enum class CheckpointUse : std::uint8_t {
  kUsed = 0,         // the heading gave the attitude; value: distance from its position, m
  kElsewhere = 1,    // the vehicle is at another place; value: distance, m
  kOld = 2,          // the checkpoint is too old; value: its age, s
  kFuture = 3,       // its time has not come yet; value: time until then, s
  kTakenMoving = 4,  // the vehicle did not stand still when it was taken
  kMoves = 5,        // the vehicle moves, or has turned since the start; value: speed, m/s
  kNotNeeded = 6,    // the filter has a heading already
  // The calibration has a verdict of its own.
  kCalibrationUsed = 7,     // value: its age, s
  kCalibrationOld = 8,      // too old; value: its age, s; below zero: its time has not come yet
  kCalibrationMounted = 9,  // mounting, or a vehicle constant, differs from what is configured;
                            // value: 0
  kCalibrationImu = 10,     // it is of another IMU; value: it differs by so many sigmas
};
// Whether a use is that of the calibration.
constexpr bool is_of_calibration(CheckpointUse use) {
  return use >= CheckpointUse::kCalibrationUsed && use <= CheckpointUse::kCalibrationImu;
}
// Returns the name of a use as outputs show it, for instance "taken_moving".
std::string_view to_string(CheckpointUse use);

}  // namespace leonav
