// This unit decides what the sentences say about how good a solution is.
#pragma once
#include "core/navigator/interface/solution.h"

namespace leonav {

// The values that the sentences have for one quality. Source: NMEA 0183 v4.10, GGA, RMC, VTG, GSA.
struct FixQuality {
  bool has_position = false;
  char gga = '0';     // 0 none, 1 GNSS, 6 dead reckoning
  char mode = 'N';    // N none, A autonomous GNSS, E dead reckoning
  char status = 'V';  // A usable, V warning
  char gsa = '1';     // 1 none, 3 three-dimensional
};

// Dead reckoning whose horizontal 1 sigma exceeds `dead_reckoning_limit_m` keeps its position and
// its mode E, but gets the warning V: programs then stop to steer by it.
FixQuality quality_of(const Solution& solution, double dead_reckoning_limit_m);

}  // namespace leonav
