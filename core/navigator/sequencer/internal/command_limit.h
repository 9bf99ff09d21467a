// The CommandLimit keeps a sender of commands from restarting the filter without end.
#pragma once
#include "core/base/gps_time.h"

namespace leonav {

// At most kMost commands in each kWindow_s of data time. While no time is known, or after it has
// stepped back, any number may come: there is nothing that they could disturb.
class CommandLimit {
 public:
  static constexpr int kMost = 5;
  static constexpr double kWindow_s = 10.0;

  bool allows(GpsTime now) {
    const bool in_window = begun_.is_set() && now.is_set() && now >= begun_ &&
                           seconds_between(now, begun_) < kWindow_s;
    if (!in_window) {
      begun_ = now;
      count_ = 0;
    }
    return ++count_ <= kMost || !now.is_set();
  }

 private:
  GpsTime begun_;
  int count_ = 0;
};

}  // namespace leonav
