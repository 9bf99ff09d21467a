// When tests begin for which any time will do.
#pragma once
#include "core/base/gps_time.h"

namespace leonav::test {

inline const GpsTime kAnyTime = GpsTime::from_week_and_tow(2200, 1000.0);

}  // namespace leonav::test
