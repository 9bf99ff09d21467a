// ImuSilence decides when epochs no longer wait for IMU samples, because none comes any more.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/base/gps_time.h"
#include "core/navigator/sequencer/internal/interval.h"

namespace leonav {

// Of epochs that are later than its last accepted sample, with no sample between them, more than
// kMinEpochs show that the IMU is silent, the newest more than kMinLengthNs after the first. Of
// epochs that come rarely two suffice, the newest more than kLongNs after that sample. The IMU is
// silent until a sample comes in time.
class ImuSilence {
 public:
  static constexpr std::size_t kMinEpochs = 4;
  static constexpr std::int64_t kMinLengthNs = 2'000'000'000;
  static constexpr std::int64_t kLongNs = 10'000'000'000;

  explicit ImuSilence(double epoch_interval_s) : max_lag_ns_(max_lag_ns(epoch_interval_s)) {}

  // Returns whether a sample is of use: later than the last epoch issued, which may be unset, or
  // not so much earlier that the next epochs, which wait for it once the silence has ended, would
  // show a silence again.
  bool is_in_time(GpsTime sample, GpsTime last_issued) const {
    return sample > last_issued ||
           (lasts_ && nanoseconds_between(last_issued, sample) <= max_lag_ns_);
  }
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
  static std::int64_t max_lag_ns(double epoch_interval_s) {
    const double epochs = static_cast<double>(kMinEpochs);
    const std::int64_t shown_ns =
        std::max(kMinLengthNs, interval_in_nanoseconds(epochs * epoch_interval_s));
    return std::min(shown_ns - interval_in_nanoseconds(epoch_interval_s), kLongNs);
  }

  std::int64_t max_lag_ns_;
  std::size_t epochs_ = 0;  // later than the last sample, until they suffice
  GpsTime first_;           // of these
  bool lasts_ = false;
};

}  // namespace leonav
