// How an IMU is built into a vehicle: what a user measures, or a log tells.
#pragma once
#include <Eigen/Core>
#include <array>
#include <string_view>

#include "core/navigator/navigator_config.h"

namespace leonav {

struct Installation {
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();   // m
  Eigen::Vector3d mounting_rpy = Eigen::Vector3d::Zero();  // rad
  double time_offset_s = 0.0;
};
Installation installation_of(const NavigatorConfig& config);
void install(const Installation& installation, NavigatorConfig* config);

// What can be found, each by itself. Angles are small turns about the body's axes.
enum class Quantity { kArmForward, kArmRight, kArmDown, kRoll, kPitch, kYaw, kTimeOffset };
inline constexpr std::size_t kQuantities = 7;
std::string_view name_of(Quantity quantity);  // "lever_arm_forward_m", "mounting_roll_deg", ...
double unit_of(Quantity quantity);            // what is printed as one, in SI units

// What one run of the filter over the log has found, beyond the installation it ran with.
struct Finding {
  std::array<double, kQuantities> change{};  // m, rad, s
  std::array<double, kQuantities> sigma{};
  std::array<bool, kQuantities> observed{};  // the log tells more than was known before it
};

// The installation with what was observed of its change. The lever arm turns with the body's axes.
Installation improved(const Installation& installation, const Finding& finding);

// `found` without those turns of the body's axes, beyond `configured`, that are not known (roll,
// pitch, yaw). The lever arm turns back with them.
Installation turned_by_known(const Installation& configured, const Installation& found,
                             const std::array<bool, 3>& known);

// One number per quantity, in SI units: lever arm, roll, pitch, yaw of the mounting, time offset.
std::array<double, kQuantities> values_of(const Installation& installation);

}  // namespace leonav
