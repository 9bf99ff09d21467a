// When the tests of monitors begin.
#pragma once
#include "core/base/gps_time.h"

namespace leonav::test {

inline const GpsTime kBeginOfWeek = GpsTime::from_week_and_tow(2300, 0.0);

}  // namespace leonav::test
