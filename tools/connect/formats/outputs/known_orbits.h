// KnownOrbits are the satellites of which any stream of the program has sent an orbit.
#pragma once
#include <array>
#include <cmath>
#include <map>

#include "core/base/gps_time.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/signals/satellite.h"

namespace leonav {

// Whether systems have their orbits from this program; a false one is never said to be without.
using ExpectedOrbits = std::array<bool, kSystemCount>;

// Elements of LEO satellites are in no receiver's format.
constexpr ExpectedOrbits expected_by_default() {
  ExpectedOrbits expected = {};
  for (const System system : {System::kGps, System::kGalileo, System::kBeidou}) {
    expected[index_of(system)] = true;
  }
  return expected;
}

// Ephemerides, and the states that corrections make of them, may come from another stream than the
// observations.
class KnownOrbits {
 public:
  void expect(const ExpectedOrbits& systems) { expected_ = systems; }
  void note(SatelliteId satellite, GpsTime reference) { last_[satellite] = reference; }

  bool is_expected(System system) const { return expected_[index_of(system)]; }
  // Returns whether leonavd, unless it is configured otherwise, can use one of any satellite of the
  // system at this time.
  bool has_any(System system, GpsTime time) const {
    const double max_age_s = EphemerisConfig().max_age_s(system);
    const auto first = last_.lower_bound({system, 0});
    for (auto one = first; one != last_.end() && one->first.system == system; ++one) {
      if (std::abs(seconds_between(time, one->second)) <= max_age_s) return true;
    }
    return false;
  }

 private:
  ExpectedOrbits expected_ = expected_by_default();
  std::map<SatelliteId, GpsTime> last_;  // reference time of the last orbit
};

}  // namespace leonav
