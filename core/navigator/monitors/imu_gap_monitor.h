// ImuGapMonitor finds that a vehicle may have turned anywhere while no IMU sample came.
#pragma once
#include <optional>

#include "core/navigator/interface/stage_work.h"

namespace leonav {

// A filter is linear in the error of its attitude. What a vehicle turns within kLongestGap_s
// without a measured rate, which may be a right angle, is beyond that: then the attitude must be
// found anew.
class ImuGapMonitor {
 public:
  static constexpr double kLongestGap_s = 3.0;

  // Adds the next epoch. Returns the length of the longest gap between the samples up to this
  // epoch, in s, if it is too long; a gap that goes on is returned at each of its epochs.
  std::optional<double> add(const EpochWork& work);

 private:
  GpsTime last_sample_;  // its end; unset: none yet
};

}  // namespace leonav
