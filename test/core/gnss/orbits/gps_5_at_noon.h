// The satellite and the time of the tests of stores and of states interpolated from them.
#pragma once
#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"

namespace leonav::test {

inline constexpr SatelliteId kG05{System::kGps, 5};
inline const GpsTime kNoon = GpsTime::from_week_and_tow(2200, 4 * 86400.0 + 43200.0);

}  // namespace leonav::test
