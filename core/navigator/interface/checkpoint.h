// A Checkpoint holds the position and heading of the vehicle at the end of a run, for the next run.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <numbers>
#include <string_view>

#include "core/base/gps_time.h"

namespace leonav {

struct Checkpoint {
  GpsTime time;
  // At `time`. A checkpoint of a moving vehicle does not state how the vehicle was parked.
  bool standing = false;
  Eigen::Vector3d antenna_p_e = Eigen::Vector3d::Zero();  // m
  double antenna_sigma = 0.0;                             // m, 3D
  double heading = 0.0;                                   // rad, clockwise from north
  double heading_sigma = 0.0;                             // rad
  Eigen::Vector3d gyro_bias_b = Eigen::Vector3d::Zero();  // rad/s
  double gyro_bias_sigma = 0.0;                           // rad/s, per axis
};

// A heading with a larger sigma is not used: the next run finds a better one by itself.
inline constexpr double kMaxCheckpointHeadingSigma = 10.0 * std::numbers::pi / 180.0;

// The use that was made of a checkpoint; codes of EventKind::kCheckpoint. On the wire: append only.
enum class CheckpointUse : std::uint8_t {
  kUsed = 0,         // the heading gave the attitude; value: m from the position in it
  kElsewhere = 1,    // the vehicle is not where it was; value: m
  kOld = 2,          // value: s since
  kFuture = 3,       // value: s until
  kTakenMoving = 4,  // the vehicle did not stand still when it was taken
  kMoves = 5,        // the vehicle moves, or has turned since the start; value: m/s
  kNotNeeded = 6,    // there is a heading already
};
std::string_view to_string(CheckpointUse use);

}  // namespace leonav
