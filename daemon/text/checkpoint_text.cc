#include "daemon/text/checkpoint_text.h"

#include <cstdio>

namespace leonav {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

}  // namespace

std::string checkpoint_text(CheckpointUse use, double value) {
  constexpr double kDay_s = 86400.0, kHour_s = 3600.0;
  switch (use) {
    case CheckpointUse::kUsed:
      return "checkpoint used: heading as it was parked, " + number(value) + " m from its position";
    case CheckpointUse::kElsewhere:
      return "checkpoint ignored: the vehicle stands " + number(value) + " m from its position";
    case CheckpointUse::kOld:
      return "checkpoint ignored: " + number(value / kDay_s) +
             " days old, more than checkpoint.max_age_s";
    case CheckpointUse::kFuture:
      return "checkpoint ignored: " + number(value) + " s later than the measurements";
    case CheckpointUse::kTakenMoving:
      return "checkpoint ignored: the vehicle was moving when it was written";
    case CheckpointUse::kMoves:
      return "checkpoint ignored: the vehicle moves, or has turned since the start";
    case CheckpointUse::kNotNeeded:
      return "checkpoint ignored: there is a heading already";
    case CheckpointUse::kCalibrationUsed:
      return value < kHour_s ? "calibration of " + number(value / 60.0) + " minutes ago used"
                             : "calibration of " + number(value / kHour_s) + " hours ago used";
    case CheckpointUse::kCalibrationOld:
      return value < 0.0
                 ? "calibration ignored: " + number(-value) + " s later than the measurements"
                 : "calibration ignored: " + number(value / kDay_s) +
                       " days old, more than checkpoint.max_age_s";
    case CheckpointUse::kCalibrationMounted:
      return "calibration ignored: vehicle.mounting_rpy_deg, vehicle.lever_arm_b_m or "
             "imu.time_offset_ms has changed";
    case CheckpointUse::kCalibrationImu:
      return "calibration ignored: that of the IMU differs by " + number(value) +
             " sigma; another IMU?";
  }
  return "checkpoint: unknown";
}

}  // namespace leonav
