// ImuGapMonitor finds that a vehicle may have turned anywhere while no IMU sample came.
#pragma once
#include <optional>

#include "core/navigator/interface/stage_work.h"

namespace leonav {

// The filter's equations are linear in the error of the attitude. Within kLongestGap_s without a
// measured rate a vehicle may turn by a right angle, for which they do not hold. So after a longer
// gap the attitude must be aligned again.
class ImuGapMonitor {
 public:
  static constexpr double kLongestGap_s = 3.0;

  // Adds the next epoch. Returns the length of a gap between samples, in s, once it is too long: at
  // the first epoch that shows it, and not again until samples have come.
  std::optional<double> add(const EpochWork& work);

 private:
  GpsTime last_sample_;   // its end; unset: none yet
  bool is_told_ = false;  // the gap since then
};

}  // namespace leonav
