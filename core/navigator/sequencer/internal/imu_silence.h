// ImuSilence decides when epochs no longer wait for IMU samples, because none comes any more.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/base/gps_time.h"

namespace leonav {

// The IMU is silent once more than kMinEpochs epochs have come that are later than its last
// accepted sample, with no sample between them, the newest more than kMinLengthNs after the first.
// It is silent until a sample is accepted. An IMU whose samples come late, but come, is not silent.
class ImuSilence {
 public:
  static constexpr std::size_t kMinEpochs = 4;
  static constexpr std::int64_t kMinLengthNs = 2'000'000'000;

  // Ends the silence, because a sample was accepted or time itself has changed.
  void clear() { epochs_ = 0; }
  // Adds an accepted epoch that is later than the last sample.
  void add_epoch(GpsTime time) {
    if (lasts()) return;
    if (epochs_++ == 0) first_ = time;
    is_long_ = nanoseconds_between(time, first_) > kMinLengthNs;
  }
  // Returns whether the IMU is silent.
  bool lasts() const { return epochs_ > kMinEpochs && is_long_; }

 private:
  std::size_t epochs_ = 0;  // since the last sample, until the silence is long enough
  GpsTime first_;           // of these
  bool is_long_ = false;
};

}  // namespace leonav
