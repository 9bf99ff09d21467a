// SmootherStatus states how a solve of the smoother ended.
#pragma once
#include <cstdint>
#include <string_view>

namespace leonav {

// Outcome of a solve. The values go over the wire: append only.
enum class SmootherStatus : std::uint8_t {
  kOk = 0,
  kNoFilter = 1,      // the filter has no state to start from
  kStarted = 2,       // a window of one keyframe: the filter's result
  kSingular = 3,      // the window has no unique solution, and it starts over
  kDiverged = 4,      // the solution is far from the filter's, and the window starts over
  kFewSatellites = 5  // too few satellites for an independent result; the window goes on
};

std::string_view to_string(SmootherStatus status);  // "ok", "singular", ...

}  // namespace leonav
