// The ProductPace makes one time that goes forward of the times that all streams show.
#pragma once
#include <optional>

#include "core/base/gps_time.h"

namespace leonav {

// Samples show their own time, while epochs and corrections come later than theirs, so that the
// times interleave; and one stream of several may have a wrong time. A time that is a little
// earlier is therefore passed over, and one that is far away as well, until no other has come for a
// while: then a receiver's time was set.
class ProductPace {
 public:
  static constexpr double kStep_s = 0.1;     // steps are at least so long
  static constexpr double kLate_s = 10.0;    // no measurement comes later than so
  static constexpr double kGap_s = 300.0;    // a service sends something at least so often
  static constexpr double kStrange_s = 5.0;  // so long a time that is far away must go on,
  static constexpr int kStrangeCalls = 3;    // and come so many times

  // Takes a time that was shown. Returns how far time has gone on, at least kStep_s; nullopt: too
  // little. The first time, and one that was set, count as kStep_s.
  std::optional<double> advance(GpsTime shown);
  // The time that counts; unset before the first one.
  GpsTime time() const { return time_; }

 private:
  bool is_set_to(GpsTime shown);

  GpsTime time_;
  GpsTime strange_begin_, strange_last_;  // of the times that are far away, one after the other
  int strange_calls_ = 0;
};

}  // namespace leonav
