#include "tools/calibrate/installation.h"

#include <numbers>

#include "core/earth/rotation.h"
#include "core/filter/update/motion_constraint.h"

namespace leonav {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d rotation_of(const Vector3d& rpy) {
  return rotation_from_euler({rpy.x(), rpy.y(), rpy.z()});
}

}  // namespace

Installation installation_of(const NavigatorConfig& config) {
  return {config.vehicle.lever_arm_b, config.vehicle.mounting_rpy, config.imu_time_offset_s};
}

void install(const Installation& installation, NavigatorConfig* config) {
  config->vehicle.lever_arm_b = installation.lever_arm_b;
  config->vehicle.mounting_rpy = installation.mounting_rpy;
  config->imu_time_offset_s = installation.time_offset_s;
}

std::string_view name_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::kArmForward:
      return "lever_arm_forward_m";
    case Quantity::kArmRight:
      return "lever_arm_right_m";
    case Quantity::kArmDown:
      return "lever_arm_down_m";
    case Quantity::kRoll:
      return "mounting_roll_deg";
    case Quantity::kPitch:
      return "mounting_pitch_deg";
    case Quantity::kYaw:
      return "mounting_yaw_deg";
    case Quantity::kTimeOffset:
      return "time_offset_ms";
  }
  return "unknown";
}

double unit_of(Quantity quantity) {
  if (quantity <= Quantity::kArmDown) return 1.0;
  return quantity == Quantity::kTimeOffset ? 1e-3 : std::numbers::pi / 180.0;
}

Installation improved(const Installation& installation, const Finding& finding) {
  const auto seen = [&](Quantity quantity) {
    const auto i = static_cast<std::size_t>(quantity);
    return finding.observed[i] ? finding.change[i] : 0.0;
  };
  // The columns are the improved axes, given in those that the filter ran with.
  const Matrix3d better = travel_axes(seen(Quantity::kYaw), seen(Quantity::kPitch)).C_bv *
                          rotation_of({seen(Quantity::kRoll), 0.0, 0.0});
  const Matrix3d C_b_imu = better.transpose() * rotation_of(installation.mounting_rpy);
  const EulerAngles angles = euler_from_rotation(C_b_imu);
  const Vector3d arm_change_b(seen(Quantity::kArmForward), seen(Quantity::kArmRight),
                              seen(Quantity::kArmDown));
  Installation result;
  result.lever_arm_b = better.transpose() * (installation.lever_arm_b + arm_change_b);
  result.mounting_rpy = {angles.roll, angles.pitch, angles.yaw};
  result.time_offset_s = installation.time_offset_s + seen(Quantity::kTimeOffset);
  return result;
}

Installation turned_by_known(const Installation& configured, const Installation& found,
                             const std::array<bool, 3>& known) {
  if (known[0] && known[1] && known[2]) return found;
  // The columns are the found axes with the unknown turns removed, given in the configured ones.
  const Matrix3d turned =
      rotation_of(configured.mounting_rpy) * rotation_of(found.mounting_rpy).transpose();
  const EulerAngles turn = euler_from_rotation(turned);
  const Matrix3d kept = rotation_of(
      {known[0] ? turn.roll : 0.0, known[1] ? turn.pitch : 0.0, known[2] ? turn.yaw : 0.0});
  const EulerAngles angles =
      euler_from_rotation(kept.transpose() * rotation_of(configured.mounting_rpy));
  Installation result = found;
  result.mounting_rpy = {angles.roll, angles.pitch, angles.yaw};
  if (!known[0] && !known[1] && !known[2])  // equal to the last bit
    result.mounting_rpy = configured.mounting_rpy;
  result.lever_arm_b = kept.transpose() * turned * found.lever_arm_b;
  return result;
}

std::array<double, kQuantities> values_of(const Installation& installation) {
  std::array<double, kQuantities> values{};
  for (int axis = 0; axis < 3; ++axis) {
    values[static_cast<std::size_t>(axis)] = installation.lever_arm_b(axis);
    values[static_cast<std::size_t>(axis) + 3] = installation.mounting_rpy(axis);
  }
  values.back() = installation.time_offset_s;
  return values;
}

}  // namespace leonav
