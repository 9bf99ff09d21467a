// OdometerIncrement holds the distance of a wheel over one interval, from its pulse counter.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"

namespace leonav {

// Distance of the wheel over (time - interval_ns, time].
struct OdometerIncrement {
  GpsTime time;                  // end of the interval
  std::int64_t interval_ns = 0;  // > 0
  double distance_m = 0.0;       // negative: in reverse
  bool sign_known = true;        // false: the counter gives the magnitude only

  GpsTime start() const { return time.plus_nanoseconds(-interval_ns); }
  double interval_s() const { return static_cast<double>(interval_ns) * 1e-9; }
};

using OdometerBlock = boost::container::static_vector<OdometerIncrement, kMaxOdometerBlock>;

}  // namespace leonav
