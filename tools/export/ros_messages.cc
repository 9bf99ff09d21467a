#include "tools/export/ros_messages.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "core/earth/rotation.h"
#include "tools/export/cdr_writer.h"
#include "tools/export/point_attributes.h"
#include "tools/export/utc_text.h"

namespace leonav {
namespace {

// The members of the types, in the syntax of ROS interface definitions; each type that is used
// follows behind a line of equality signs.
constexpr std::string_view kFixDefinition =
    R"(int8 STATUS_NO_FIX=-1
int8 STATUS_FIX=0
uint8 COVARIANCE_TYPE_UNKNOWN=0
uint8 COVARIANCE_TYPE_APPROXIMATED=1
uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2
uint8 COVARIANCE_TYPE_KNOWN=3
std_msgs/Header header
sensor_msgs/NavSatStatus status
float64 latitude
float64 longitude
float64 altitude
float64[9] position_covariance
uint8 position_covariance_type
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: sensor_msgs/NavSatStatus
int8 STATUS_NO_FIX=-1
int8 STATUS_FIX=0
int8 STATUS_SBAS_FIX=1
int8 STATUS_GBAS_FIX=2
uint16 SERVICE_GPS=1
uint16 SERVICE_GLONASS=2
uint16 SERVICE_COMPASS=4
uint16 SERVICE_GALILEO=8
int8 status
uint16 service
)";
constexpr std::string_view kOdometryDefinition =
    R"(std_msgs/Header header
string child_frame_id
geometry_msgs/PoseWithCovariance pose
geometry_msgs/TwistWithCovariance twist
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/PoseWithCovariance
geometry_msgs/Pose pose
float64[36] covariance
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: geometry_msgs/TwistWithCovariance
geometry_msgs/Twist twist
float64[36] covariance
================================================================================
MSG: geometry_msgs/Twist
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
)";
constexpr std::string_view kSourceDefinition = "string data\n";
constexpr std::string_view kMap = "map", kVehicle = "base_link";
constexpr std::uint16_t kGpsGalileoBeidou = 1 | 8 | 4;

using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

void put_header(GpsTime time, std::string_view frame, CdrWriter* writer) {
  const std::int64_t ns = unix_nanoseconds(time);
  writer->put(static_cast<std::int32_t>(ns / kNanosecondsPerSecond))
      .put(static_cast<std::uint32_t>(ns % kNanosecondsPerSecond))
      .text(frame);
}

void put_vector(const Eigen::Vector3d& vector, CdrWriter* writer) {
  for (const double value : vector) writer->put(value);
}

void put_matrix(const Matrix6& matrix, CdrWriter* writer) { writer->array({matrix.data(), 36}); }

// C_un: from north, east, down to east, north, up.
Eigen::Matrix3d east_north_up_from_ned() {
  Eigen::Matrix3d rotation;
  rotation << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  return rotation;
}

// C_bf: from forward, left, up to forward, right, down, and back.
Eigen::Matrix3d turn_about_forward() { return Eigen::Vector3d(1, -1, -1).asDiagonal(); }

Eigen::Matrix3d squares(const std::optional<Eigen::Vector3d>& sigma) {
  const Eigen::Vector3d variances =
      sigma ? Eigen::Vector3d(sigma->cwiseAbs2()) : Eigen::Vector3d::Constant(kUnknownVariance);
  return variances.asDiagonal();
}

// Returns the covariance of the rotation about the axes north, east, down from that of roll, pitch
// and yaw: each angle turns about an axis that the angles before it have turned.
Eigen::Matrix3d rotation_covariance_n(const EulerAngles& angles,
                                      const std::optional<Eigen::Vector3d>& sigma_rpy) {
  const Eigen::Matrix3d by_yaw = rotation_from_euler({0.0, 0.0, angles.yaw});
  Eigen::Matrix3d axes;
  axes.col(0) = rotation_from_euler({0.0, angles.pitch, angles.yaw}) * Eigen::Vector3d::UnitX();
  axes.col(1) = by_yaw * Eigen::Vector3d::UnitY();
  axes.col(2) = Eigen::Vector3d::UnitZ();
  return axes * squares(sigma_rpy) * axes.transpose();
}

}  // namespace

const std::array<RosTopic, kRosTopicCount>& ros_topics() {
  static constexpr std::array<RosTopic, kRosTopicCount> kTopics = {
      {{"/leonav/fix", "sensor_msgs/msg/NavSatFix", kFixDefinition},
       {"/leonav/odometry", "nav_msgs/msg/Odometry", kOdometryDefinition},
       {"/leonav/source", "std_msgs/msg/String", kSourceDefinition}}};
  return kTopics;
}

bool is_ros_time(GpsTime time) {
  const std::int64_t ns = unix_nanoseconds(time);
  return ns >= 0 && ns / kNanosecondsPerSecond <= std::numeric_limits<std::int32_t>::max();
}

std::string nav_sat_fix(const SolutionRow& row) {
  CdrWriter writer;
  put_header(row.pva.time, kVehicle, &writer);
  writer.put(std::int8_t{0}).put(kGpsGalileoBeidou);
  writer.put(row.pva.position.latitude * kDegreesPerRadian)
      .put(row.pva.position.longitude * kDegreesPerRadian)
      .put(row.pva.position.height);
  const Eigen::Vector3d sigma = row.sigma_p_n.value_or(Eigen::Vector3d::Zero());
  const std::array<double, 9> covariance = {
      sigma.y() * sigma.y(), 0, 0, 0, sigma.x() * sigma.x(), 0, 0, 0, sigma.z() * sigma.z()};
  writer.array(covariance).put(static_cast<std::uint8_t>(row.sigma_p_n ? 2 : 0));
  return writer.bytes();
}

std::optional<std::string> odometry(const SolutionRow& row, const Geodetic& origin) {
  if (!row.pva.roll || !row.pva.pitch || !row.pva.yaw) return std::nullopt;
  const EulerAngles angles{*row.pva.roll, *row.pva.pitch, *row.pva.yaw};
  const Eigen::Matrix3d C_nb = rotation_from_euler(angles);
  const Eigen::Matrix3d C_me = east_north_up_from_ned() * rotation_ecef_to_ned(origin);
  const Eigen::Matrix3d C_mn = C_me * rotation_ecef_to_ned(row.pva.position).transpose();
  const Eigen::Matrix3d C_fn = turn_about_forward() * C_nb.transpose();
  const Eigen::Vector3d p_m = C_me * (to_ecef(row.pva.position) - to_ecef(origin));
  const Eigen::Quaterniond q_mf(Eigen::Matrix3d(C_mn * C_fn.transpose()));

  Matrix6 pose = Matrix6::Zero(), twist = Matrix6::Zero();
  pose.topLeftCorner<3, 3>() = C_mn * squares(row.sigma_p_n) * C_mn.transpose();
  pose.bottomRightCorner<3, 3>() =
      C_mn * rotation_covariance_n(angles, row.sigma_rpy) * C_mn.transpose();
  twist.topLeftCorner<3, 3>() =
      C_fn * squares(row.pva.v_n ? row.sigma_v_n : std::nullopt) * C_fn.transpose();
  twist.bottomRightCorner<3, 3>() = kUnknownVariance * Eigen::Matrix3d::Identity();

  CdrWriter writer;
  put_header(row.pva.time, kMap, &writer);
  writer.text(kVehicle);
  put_vector(p_m, &writer);
  for (const double value : q_mf.coeffs()) writer.put(value);  // x, y, z, w
  put_matrix(pose, &writer);
  put_vector(C_fn * row.pva.v_n.value_or(Eigen::Vector3d::Zero()), &writer);
  put_vector(Eigen::Vector3d::Zero(), &writer);
  put_matrix(twist, &writer);
  return writer.bytes();
}

std::string source_text(const SolutionRow& row) {
  return CdrWriter().text(source_name(row)).bytes();
}

}  // namespace leonav
