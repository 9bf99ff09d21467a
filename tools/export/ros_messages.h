// This unit turns points into messages of ROS 2: sensor_msgs/NavSatFix, nav_msgs/Odometry and
// std_msgs/String.
//
// Frames are those of REP 103 and REP 105: "map" is tangential at the origin with axes east, north,
// up; "base_link" has the axes forward, left, up of the vehicle at the IMU's centre.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/earth/ellipsoid.h"
#include "drivers/csv/solution_csv.h"

namespace leonav {

// A topic of the file.
struct RosTopic {
  std::string_view name;        // "/leonav/fix"
  std::string_view type;        // "sensor_msgs/msg/NavSatFix"
  std::string_view definition;  // the type's and those of the types in it, as rosbag2 stores them
};
inline constexpr std::size_t kRosTopicCount = 3;
enum class RosTopicIndex : std::uint8_t { kFix, kOdometry, kSource };
const std::array<RosTopic, kRosTopicCount>& ros_topics();

// Returns whether ROS can hold the time, whose seconds have 32 bits: from 1970 to 2038.
bool is_ros_time(GpsTime time);

// These return a message in CDR. Precondition: is_ros_time(row.pva.time).

// Position in degrees, height above the ellipsoid and covariance east, north, up; the covariance
// type is unknown without sigmas. The status is "fix" of every point, also by inertial navigation
// alone: the source says which.
std::string nav_sat_fix(const SolutionRow& row);

// Pose in "map", velocity in the vehicle's axes, with covariances. Rates are not part of a
// solution: they are zero with a variance of kUnknownVariance. Returns nullopt without attitude.
std::optional<std::string> odometry(const SolutionRow& row, const Geodetic& origin);
inline constexpr double kUnknownVariance = 1e9;

// The name of the source: "aligning", "ins", "prediction", "ekf" or "smoother".
std::string source_text(const SolutionRow& row);

}  // namespace leonav
