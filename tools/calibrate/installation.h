// Installation describes how an IMU is built into a vehicle.
#pragma once
#include <Eigen/Core>
#include <array>
#include <string_view>

#include "core/navigator/interface/navigator_config.h"

namespace leonav {

// Lever arm (IMU to antenna, body axes), mounting angles (IMU axes in body axes), and time offset.
struct Installation {
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();   // m
  Eigen::Vector3d mounting_rpy = Eigen::Vector3d::Zero();  // rad
  double time_offset_s = 0.0;
};
// Reads an installation from a configuration, or writes it there.
Installation installation_of(const NavigatorConfig& config);
void install(const Installation& installation, NavigatorConfig* config);

// The quantities that can be found independently. Angles are small rotations about the body's axes.
enum class Quantity { kArmForward, kArmRight, kArmDown, kRoll, kPitch, kYaw, kTimeOffset };
inline constexpr std::size_t kQuantities = 7;
// Returns the name in the output: "lever_arm_forward_m", "mounting_roll_deg", ...
std::string_view name_of(Quantity quantity);
// Returns the SI value of one printed unit.
double unit_of(Quantity quantity);

// Result of one pass over the log, relative to the installation it ran with.
struct Finding {
  std::array<double, kQuantities> change{};  // m, rad, s
  std::array<double, kQuantities> sigma{};
  std::array<bool, kQuantities> observed{};  // the log has reduced the sigma enough
};

// Returns the installation with the observed changes applied. The lever arm turns with the body's
// axes.
Installation improved(const Installation& installation, const Finding& finding);

// Returns `found` without those rotations of the body's axes, relative to `configured`, that are
// not known (roll, pitch, yaw). The lever arm turns back with them.
Installation turned_by_known(const Installation& configured, const Installation& found,
                             const std::array<bool, 3>& known);

// Returns one number per quantity, in SI units: lever arm, roll, pitch, yaw of the mounting, time
// offset.
std::array<double, kQuantities> values_of(const Installation& installation);

}  // namespace leonav
