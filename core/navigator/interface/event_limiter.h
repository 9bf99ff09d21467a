// This function thins events that repeat: it admits the first 16 occurrences and then each 256th.
#pragma once
#include <cstdint>

namespace leonav {

// Returns whether an occurrence is published; `count` is the number so far, this one included. An
// input that is wrong at every message must not hide the other events; counters hold the full
// number.
inline bool is_event_due(std::uint64_t count) { return count <= 16 || count % 256 == 0; }

}  // namespace leonav
