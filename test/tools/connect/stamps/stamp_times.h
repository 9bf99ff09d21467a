// The times of the tests of stamps.
#pragma once
#include <cstdint>

#include "core/base/gps_time.h"

namespace leonav::test {

inline constexpr std::int64_t kSecond_ns = kNanosecondsPerSecond, kMillisecond_ns = 1'000'000;
inline const GpsTime kStart = GpsTime::from_week_and_tow(2136, 345'600.0);
// When the host's clock of arrivals shows zero, GPS time is kStart.
inline GpsTime gps_at(std::int64_t host_ns) { return kStart.plus_nanoseconds(host_ns); }

}  // namespace leonav::test
