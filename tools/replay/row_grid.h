// RowGrid chooses the rows of a table at a rate.
#pragma once
#include <cmath>
#include <cstdint>

#include "core/base/gps_time.h"

namespace leonav {

// The first row at or after every point of a grid that is anchored to GPS time, so that rows of
// different runs coincide. Where time goes back behind the last row, as between two drives in one
// log, the grid begins anew.
class RowGrid {
 public:
  explicit RowGrid(double rate_hz)
      : interval_ns_(static_cast<std::int64_t>(std::llround(1e9 / rate_hz))) {}

  // Returns whether the row is one of the table's.
  bool takes(GpsTime time) {
    if (time < next_ && time >= last_) return false;
    last_ = time;
    next_ = GpsTime::from_nanoseconds((time.nanoseconds() / interval_ns_ + 1) * interval_ns_);
    return true;
  }

 private:
  std::int64_t interval_ns_;
  GpsTime last_, next_;  // the last row, and the point of the grid after it
};

}  // namespace leonav
