// Notices satellites whose orbit comes from another source than before.
#pragma once
#include <array>
#include <cstdint>

#include "core/gnss/satellite_state.h"

namespace leonav {

enum class OrbitChange : std::uint8_t {
  kNone = 0,
  kFallback,  // from precise to broadcast
  kReturn,    // from broadcast to precise, also for the first time
};

class OrbitWatch {
 public:
  // Takes note of what serves `id` in this epoch, and compares it with what did when the satellite
  // was last seen: where the source changes the range steps, by a metre or so. kNone (no state) is
  // no news.
  OrbitChange look(SatelliteId id, OrbitSource source) {
    if (!is_valid(id) || source == OrbitSource::kNone) return OrbitChange::kNone;
    OrbitSource& last = last_[index_of(id.system)][id.number];
    const OrbitSource before = last;
    last = source;
    if (before == OrbitSource::kNone || before == source) return OrbitChange::kNone;
    return source == OrbitSource::kBroadcast ? OrbitChange::kFallback : OrbitChange::kReturn;
  }

 private:
  static constexpr std::size_t kNumbers = 400;  // LEO has the highest, 399
  std::array<std::array<OrbitSource, kNumbers>, kSystemCount> last_{};
};

}  // namespace leonav
