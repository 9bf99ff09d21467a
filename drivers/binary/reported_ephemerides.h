// ReportedEphemerides remembers what was last reported of each satellite, so that repetitions of a
// set are told from new ones.
#pragma once
#include <map>
#include <utility>

#include "core/gnss/orbits/ephemeris.h"

namespace leonav {

// It holds one set per satellite and navigation message.
class ReportedEphemerides {
 public:
  // Returns whether the set differs from the last one that was given for its satellite and message,
  // and remembers it. Two sets with the same contents are the same, whenever they were sent.
  bool is_new(const Ephemeris& ephemeris);

 private:
  std::map<std::pair<NavigationMessage, SatelliteId>, Ephemeris> last_;
};

}  // namespace leonav
