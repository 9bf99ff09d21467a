// ImuSilence decides when epochs no longer wait for IMU samples, because none comes any more.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"
#include "core/navigator/sequencer/internal/interval.h"

namespace leonav {

// Of epochs that are later than its last accepted sample, with no sample in time between them, more
// than kMinEpochs show that the IMU is silent, the newest more than kMinLengthNs after the first.
// Of epochs that come rarely two suffice, the newest more than kLongNs after that sample. The IMU
// is silent until a sample comes in time.
class ImuSilence {
 public:
  static constexpr std::size_t kMinEpochs = 4;
  static constexpr std::int64_t kMinLengthNs = 2'000'000'000;
  static constexpr std::int64_t kLongNs = 10'000'000'000;

  explicit ImuSilence(double epoch_interval_s)
      : interval_ns_(interval_in_nanoseconds(epoch_interval_s)), mean_interval_ns_(interval_ns_) {}

  // Returns whether a sample comes in time: later than the last epoch issued, unless that one was
  // issued without its samples. In a silence it is in time if it is earlier than the newest epoch,
  // which may wait still, by so little that the next ones, which wait for it then, do not show a
  // silence again. The times of epochs may be unset.
  bool is_in_time(GpsTime sample, GpsTime last_issued, GpsTime newest) const {
    if (lasts_) return nanoseconds_between(newest, sample) < max_lag_ns();
    return sample > last_issued && !misses_;
  }
  // Ends the silence, because a sample came in time or time itself has changed.
  void clear() {
    epochs_ = 0;
    lasts_ = misses_ = false;
  }
  // Adds an epoch that was issued: whether the IMU had passed it, or it was not waited for longer.
  void add_issued(bool has_passed) { misses_ = !has_passed; }
  // Adds an accepted epoch. `last_sample`: end of the last accepted sample, or unset.
  void add_epoch(GpsTime time, GpsTime last_sample) {
    if (last_epoch_.is_set() && time > last_epoch_) {
      const std::int64_t step_ns = std::min(nanoseconds_between(time, last_epoch_), interval_ns_);
      mean_interval_ns_ += (step_ns - mean_interval_ns_) / 4;
    }
    last_epoch_ = time;
    if (lasts_ || time <= last_sample) return;
    if (epochs_++ == 0) first_ = time;
    const bool many = epochs_ > kMinEpochs && nanoseconds_between(time, first_) > kMinLengthNs;
    const GpsTime begin = last_sample.is_set() ? last_sample : first_;
    lasts_ = many || (epochs_ > 1 && nanoseconds_between(time, begin) > kLongNs);
  }
  // Returns whether the IMU is silent.
  bool lasts() const { return lasts_; }

 private:
  // By both rules of a silence, and by how many epochs can wait.
  std::int64_t max_lag_ns() const {
    const std::int64_t interval_ns = mean_interval_ns_;
    const auto epochs = static_cast<std::int64_t>(kMinEpochs);
    const auto waiting = static_cast<std::int64_t>(kMaxPendingEpochs);
    return std::min({std::max(kMinLengthNs, epochs * interval_ns) - interval_ns,
                     std::max(interval_ns, kLongNs - interval_ns), (waiting - 1) * interval_ns});
  }

  std::int64_t interval_ns_;       // configured
  std::int64_t mean_interval_ns_;  // of the last epochs, no longer than configured
  GpsTime last_epoch_;
  std::size_t epochs_ = 0;  // later than the last sample, until they suffice
  GpsTime first_;           // of these
  bool lasts_ = false;
  bool misses_ = false;  // the last epoch was issued without its samples
};

}  // namespace leonav
