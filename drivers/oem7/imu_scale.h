// This unit holds what a count of RAWIMU and its relatives stands for, by type of IMU.
#pragma once
#include <cstdint>
#include <optional>

namespace leonav {

// Increments per count.
struct ImuScale {
  double angle_rad = 0.0;
  double velocity_m_s = 0.0;
};

// Returns the scale of a type, the number in RAWIMUX and INSCONFIG; nullopt for one that the manual
// states no scale of. Source: OEM7 manual, RAWIMUSX, table "Raw IMU Scale Factors", and CONNECTIMU
// for the numbers. Of the KVH sensors the manual states the angle in radians.
std::optional<ImuScale> documented_imu_scale(std::uint32_t imu_type);

}  // namespace leonav
