// The Oem7StreamOptions are what a stream's configuration says of a SPAN receiver's inertial
// sensor.
#pragma once
#include <optional>

#include "drivers/oem7/imu_scale.h"

namespace leonav {

struct Oem7StreamOptions {
  bool is_inertial = false;           // its samples are published
  std::optional<ImuScale> imu_scale;  // of a count; empty: as documented for its type
};

}  // namespace leonav
