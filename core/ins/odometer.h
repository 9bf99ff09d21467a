// What a wheel's pulse counter tells, as increments over an interval, never as rates.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "core/capacity.h"
#include "core/time/gps_time.h"

namespace leonav {

// Way of the wheel over (time - interval_ns, time].
struct OdometerIncrement {
  GpsTime time;                  // end of the interval
  std::int64_t interval_ns = 0;  // > 0
  double distance_m = 0.0;       // negative: in reverse
  bool sign_known = true;        // false: the counter tells its magnitude alone

  GpsTime start() const { return time.plus_nanoseconds(-interval_ns); }
  double interval_s() const { return static_cast<double>(interval_ns) * 1e-9; }
};

using OdometerBlock = boost::container::static_vector<OdometerIncrement, kMaxOdometerBlock>;

}  // namespace leonav
