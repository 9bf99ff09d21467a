// An event that repeats is published for its first 16 occurrences and then for each 256th.
#pragma once
#include <cstdint>

namespace leonav {

// `count`: occurrences so far, this one included. A stream that errs at every message must not
// drown the other events; the counters hold the full number.
inline bool is_event_due(std::uint64_t count) { return count <= 16 || count % 256 == 0; }

}  // namespace leonav
