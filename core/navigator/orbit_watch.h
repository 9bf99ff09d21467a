// Notices satellites that fall back from precise to broadcast elements.
#pragma once
#include <array>

#include "core/gnss/satellite_state.h"

namespace leonav {

class OrbitWatch {
 public:
  // Takes note of what serves `id` in this epoch. True if that is broadcast elements and was a
  // precise state when the satellite was last seen: its range steps, by a metre or so. kNone (no
  // state) is no news.
  bool falls_back(SatelliteId id, OrbitSource source) {
    if (!is_valid(id) || source == OrbitSource::kNone) return false;
    OrbitSource& last = last_[index_of(id.system)][id.number];
    const bool fell = last == OrbitSource::kPrecise && source == OrbitSource::kBroadcast;
    last = source;
    return fell;
  }

 private:
  static constexpr std::size_t kNumbers = 400;  // LEO has the highest, 399
  std::array<std::array<OrbitSource, kNumbers>, kSystemCount> last_{};
};

}  // namespace leonav
