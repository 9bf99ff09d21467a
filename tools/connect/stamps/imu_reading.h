// An ImuReading is what one message of an inertial sensor says, whatever its format.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "core/base/gps_time.h"

namespace leonav {

// Axes are those of the sensor, or as its line layout turns them: forward, right, down.
struct ImuReading {
  std::int64_t arrival_ns = 0;           // of the ArrivalClock
  std::optional<GpsTime> gps_time;       // by the sensor itself
  std::optional<std::int64_t> clock_ns;  // the sensor's own clock
  double clock_step_s = 0.0;             // what that clock shows is cut off to a multiple of this
  std::optional<bool> has_pulse;         // a pulse left the sensor at this sample; empty: not told
  bool are_increments = false;
  // Of increments, where the sensor gives it; they end at the reading's time.
  std::optional<double> interval_s;
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();   // rad/s; of increments rad
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();  // m/s^2; of increments m/s
};

// Of three numbers as a decoder gives them.
inline Eigen::Vector3d to_vector(const std::array<double, 3>& from) {
  return {from[0], from[1], from[2]};
}

}  // namespace leonav
