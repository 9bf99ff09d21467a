// OrbitSourceMonitor detects satellites whose orbit or clock comes from another source than before.
#pragma once
#include <array>
#include <cstdint>

#include "core/gnss/orbits/satellite_state.h"

namespace leonav {

enum class OrbitChange : std::uint8_t {
  kNone = 0,
  kFallback,       // from precise to broadcast
  kReturn,         // from broadcast to precise, also for the first time
  kClockFallback,  // precise: from the clocks of a clock file to those of the orbit file
  kClockReturn,    // the way back, also for the first time
};

class OrbitSourceMonitor {
 public:
  // Records the source of `id` in this epoch and compares it with that of the last epoch with this
  // satellite. A new source steps the range by about a metre; a new clock alone by centimetres to
  // decimetres. OrbitSource::kNone (no state) changes nothing.
  OrbitChange update(SatelliteId id, OrbitSource source, bool clock_from_file) {
    if (!is_valid(id) || source == OrbitSource::kNone) return OrbitChange::kNone;
    const std::size_t place = table_index_of(id);
    if (place >= last_.size()) return OrbitChange::kNone;
    Last& last = last_[place];
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
