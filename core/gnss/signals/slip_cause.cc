#include "core/gnss/signals/slip_cause.h"

namespace leonav {

std::string_view to_string(SlipCause cause) {
  switch (cause) {
    case SlipCause::kGap:
      return "gap";
    case SlipCause::kSignalChanged:
      return "signal_changed";
    case SlipCause::kLossOfLock:
      return "loss_of_lock";
    case SlipCause::kLockTime:
      return "lock_time";
    case SlipCause::kGeometryFree:
      return "geometry_free";
    case SlipCause::kMelbourneWuebbena:
      return "melbourne_wuebbena";
    case SlipCause::kDoppler:
      return "doppler";
    case SlipCause::kHalfCycle:
      return "half_cycle";
    case SlipCause::kRangeChange:
      return "range_change";
    case SlipCause::kFilter:
      return "filter";
    case SlipCause::kClockJump:
      return "clock_jump";
    case SlipCause::kUntested:
      return "untested";
  }
  return "unknown";
}

}  // namespace leonav
