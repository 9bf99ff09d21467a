// OrbitSourceMonitor finds satellites whose orbit or clock comes from another source than before.
#pragma once
#include <array>
#include <cstdint>

#include "core/gnss/orbits/satellite_state.h"

namespace leonav {

// The change of a satellite's orbit source or clock source.
enum class OrbitChange : std::uint8_t {
  kNone = 0,
  kFallback,       // from precise states to broadcast elements
  kReturn,         // from broadcast elements to precise states, also for the first time
  kClockFallback,  // with precise states: from a clock file's clocks to the orbit file's
  kClockReturn,    // from the orbit file's clocks to a clock file's, also for the first time
};

// OrbitSourceMonitor remembers the last source of every satellite.
class OrbitSourceMonitor {
 public:
  // Records the source of satellite `id` in this epoch and returns the change since the satellite
  // had a state last. Where the orbit source changes, the range steps by about a metre; where only
  // the clock source changes, by centimetres to decimetres. An epoch without a state (kNone)
  // changes nothing.
  OrbitChange update(SatelliteId id, OrbitSource source, bool clock_from_file) {
    if (!is_valid(id) || source == OrbitSource::kNone) return OrbitChange::kNone;
    const std::size_t index = table_index_of(id);
    if (index >= last_.size()) return OrbitChange::kNone;
    Last& last = last_[index];
    const Last before = last;
    last = {source, clock_from_file};
    if (before.source == OrbitSource::kNone) return OrbitChange::kNone;
    if (before.source != source)
      return source == OrbitSource::kBroadcast ? OrbitChange::kFallback : OrbitChange::kReturn;
    if (before.clock_from_file == clock_from_file) return OrbitChange::kNone;
    return clock_from_file ? OrbitChange::kClockReturn : OrbitChange::kClockFallback;
  }

 private:
  struct Last {
    OrbitSource source = OrbitSource::kNone;
    bool clock_from_file = false;
  };
  std::array<Last, kMaxEphemerisSatellites> last_{};
};

}  // namespace leonav
