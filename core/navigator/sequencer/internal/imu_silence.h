// ImuSilence decides when epochs no longer wait for IMU samples, because none comes any more.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/base/gps_time.h"

namespace leonav {

// Of epochs that are later than its last accepted sample, with no sample between them, more than
// kMinEpochs show that the IMU is silent, the newest more than kMinLengthNs after the first. Of
// epochs that come rarely two suffice, the newest more than kLongNs after that sample. The IMU is
// silent until a sample is accepted. Samples that come too late for the epochs issued do not count.
class ImuSilence {
 public:
  static constexpr std::size_t kMinEpochs = 4;
  static constexpr std::int64_t kMinLengthNs = 2'000'000'000;
  static constexpr std::int64_t kLongNs = 10'000'000'000;

  // Ends the silence, because a sample came in time or time itself has changed.
  void clear() {
    epochs_ = 0;
    lasts_ = false;
  }
  // Adds an accepted epoch. `last_sample`: end of the last accepted sample, or unset.
  void add_epoch(GpsTime time, GpsTime last_sample) {
    if (lasts_ || time <= last_sample) return;
    if (epochs_++ == 0) first_ = time;
    const bool many = epochs_ > kMinEpochs && nanoseconds_between(time, first_) > kMinLengthNs;
    const GpsTime begin = last_sample.is_set() ? last_sample : first_;
    lasts_ = many || (epochs_ > 1 && nanoseconds_between(time, begin) > kLongNs);
  }
  // Returns whether the IMU is silent.
  bool lasts() const { return lasts_; }

 private:
  std::size_t epochs_ = 0;  // later than the last sample, until they suffice
  GpsTime first_;           // of these
  bool lasts_ = false;
};

}  // namespace leonav
