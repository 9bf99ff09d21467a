// How a solve of the smoother ended.
#pragma once
#include <cstdint>
#include <string_view>

namespace leonav {

// On the wire: append only.
enum class SmootherStatus : std::uint8_t {
  kOk = 0,
  kNoFilter = 1,      // the filter has no state to start from
  kStarted = 2,       // a window of one keyframe: the filter's answer
  kSingular = 3,      // the window has no unique solution: it starts over
  kDiverged = 4,      // nor one that is near the filter's: likewise
  kFewSatellites = 5  // too few measurements for an answer of its own; it goes on
};

std::string_view to_string(SmootherStatus status);  // "ok", "singular", ...

}  // namespace leonav
