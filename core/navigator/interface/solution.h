// A Solution is position, velocity and attitude of the IMU centre at one instant, with sigmas.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "core/base/gps_time.h"
#include "core/inertial/strapdown/nav_state.h"

namespace leonav {

// What the solution rests on. On the wire: append only.
enum class Source : std::uint8_t {
  kNone = 0,
  kAligning = 1,
  kInsOnly = 2,
  kEkf = 3,
  kSmoother = 4
};
std::string_view to_string(Source source);  // "none", "aligning", "ins", "ekf", "smoother"

// Sigmas are 1 sigma, of the errors in north, east, down.
struct Solution {
  std::uint64_t sequence = 0;  // counts solutions, from 1
  GpsTime time;
  Source source = Source::kNone;
  bool has_attitude = false;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();
  double latitude = 0.0, longitude = 0.0, height = 0.0;  // rad, rad, m
  Eigen::Vector3d v_n = Eigen::Vector3d::Zero();         // m/s, north east down
  double roll = 0.0, pitch = 0.0, yaw = 0.0;             // rad
  Eigen::Vector3d sigma_p_n = Eigen::Vector3d::Zero();   // m
  Eigen::Vector3d sigma_v_n = Eigen::Vector3d::Zero();   // m/s
  Eigen::Vector3d sigma_rpy = Eigen::Vector3d::Zero();   // rad
  ImuErrors errors;                                      // of the anchor in use
  std::uint64_t anchor_epoch = 0;                        // k of the epoch of that anchor
  double jump_m = 0.0;  // how far the newest anchor moved the answer; 0 between commits
};

}  // namespace leonav
