// A StampDecision states whether the stamp of an input fits the time of the inputs before it.
#pragma once
#include "core/navigator/interface/input_fault.h"

namespace leonav {

struct StampDecision {
  InputFault fault = InputFault::kNone;  // kNone: the input is accepted
  bool starts_new_time = false;          // accepted, and everything kept belongs to an older time
  double jump_s = 0.0;                   // new time minus old time, where a new time starts
};

// A stamp further than this from everything seen is wild.
inline constexpr std::int64_t kMaxStampAheadNs = 10 * kNanosecondsPerSecond;

}  // namespace leonav
