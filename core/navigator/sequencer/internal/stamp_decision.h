// StampDecision states whether the stamp of an input fits the time of the inputs before it.
#pragma once
#include <cstdint>

#include "core/base/gps_time.h"
#include "core/navigator/interface/input_fault.h"

namespace leonav {

// The decision about one stamp.
struct StampDecision {
  InputFault fault = InputFault::kNone;  // kNone: the input is accepted
  bool starts_new_time = false;          // a time step: everything kept belongs to the old time
  double jump_s = 0.0;                   // new time minus old time, at a time step
  bool contradicts_imu = false;          // at a time step: the IMU's samples come in the old time
};

// A stamp further than this from all inputs so far is wrong, or begins a time step.
inline constexpr std::int64_t kMaxStampAheadNs = 10 * kNanosecondsPerSecond;

}  // namespace leonav
