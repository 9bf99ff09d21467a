// KnownOrbits are the satellites of which any stream of the program has sent an orbit.
#pragma once
#include <cmath>
#include <map>

#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"

namespace leonav {

// Ephemerides, and the states that corrections make of them, may come from another stream than the
// observations.
class KnownOrbits {
 public:
  // From the reference time of an orbit on, so long, it counts.
  static constexpr double kMaxAge_s = 4 * 3600.0;

  void note(SatelliteId satellite, GpsTime reference) { last_[satellite] = reference; }
  // Returns whether one of any satellite of the system counts at this time.
  bool has_any(System system, GpsTime time) const {
    const auto first = last_.lower_bound({system, 0});
    for (auto one = first; one != last_.end() && one->first.system == system; ++one) {
      if (std::abs(seconds_between(time, one->second)) <= kMaxAge_s) return true;
    }
    return false;
  }

 private:
  std::map<SatelliteId, GpsTime> last_;  // reference time of the last orbit
};

}  // namespace leonav
