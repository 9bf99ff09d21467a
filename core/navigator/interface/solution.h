// Solution is position, velocity and attitude of the IMU's centre at one instant, with sigmas.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string_view>

#include "core/base/gps_time.h"
#include "core/inertial/strapdown/nav_state.h"

namespace leonav {

// The source of a solution. On the wire: append only.
enum class Source : std::uint8_t {
  kNone = 0,      // there is no solution
  kAligning = 1,  // the filter, without attitude yet
  kInsOnly = 2,   // inertial navigation without recent GNSS
  kEkf = 3,       // the filter, with recent GNSS
  kSmoother = 4   // the smoother, with recent GNSS
};
// Returns "none", "aligning", "ins", "ekf" or "smoother".
std::string_view to_string(Source source);

// A solution in ECEF and geodetic coordinates (WGS84). Sigmas are 1 sigma of the errors in north,
// east, down.
struct Solution {
  std::uint64_t sequence = 0;  // counts solutions, from 1
  GpsTime time;
  Source source = Source::kNone;
  bool has_attitude = false;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();         // m
  double latitude = 0.0, longitude = 0.0, height = 0.0;  // rad, rad, m
  Eigen::Vector3d v_n = Eigen::Vector3d::Zero();         // m/s, north, east, down
  double roll = 0.0, pitch = 0.0, yaw = 0.0;             // rad; zero without attitude
  Eigen::Vector3d sigma_p_n = Eigen::Vector3d::Zero();   // m
  Eigen::Vector3d sigma_v_n = Eigen::Vector3d::Zero();   // m/s
  Eigen::Vector3d sigma_rpy = Eigen::Vector3d::Zero();   // rad
  ImuErrors errors;                                      // IMU errors of the anchor in use
  std::uint64_t anchor_epoch = 0;                        // index k of the epoch of that anchor
  double jump_m = 0.0;  // how far a new anchor has moved the solution; 0 between commits
  // Protection levels: bounds that the errors exceed with the configured integrity risk at most, as
  // far as the filter's covariance and the overbound hold.
  // NaN: none is known; of the heading also without attitude.
  double horizontal_protection_m = std::numeric_limits<double>::quiet_NaN();
  double vertical_protection_m = std::numeric_limits<double>::quiet_NaN();
  double heading_protection = std::numeric_limits<double>::quiet_NaN();  // rad
};

}  // namespace leonav
