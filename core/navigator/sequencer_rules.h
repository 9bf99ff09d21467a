// What the Sequencer's parts have in common; no other stage's business.
#pragma once
#include <cstdint>

#include "core/navigator/sequencer.h"

namespace leonav {

inline constexpr std::int64_t kMaxAheadNs =
    static_cast<std::int64_t>(Sequencer::kMaxAheadS) * kNanosecondsPerSecond;

inline std::int64_t nanoseconds_between(GpsTime a, GpsTime b) {
  return a.nanoseconds() - b.nanoseconds();
}

// A stream that errs at every message must not drown the events; the counters have the number.
inline bool worth_an_event(std::uint64_t count) { return count <= 16 || count % 256 == 0; }

}  // namespace leonav
