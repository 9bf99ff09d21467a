// ImuTimeline lays IMU samples end to end although their stamps jitter.
#pragma once
#include <cstdint>

#include "core/inertial/strapdown/imu.h"

namespace leonav {

// The deviation of a stamp is its difference from the end that the sample would have if it followed
// the previous one with its own interval. Only jitter makes a sample start before the previous
// one's end, so the largest recent overlap measures the jitter:
// - In a stream that overlaps by no more than half an interval, stamps are used as they are: a
//   sample starts at the previous one's end and ends at its stamp. If it is later than half an
//   interval and the jitter, it lies after a gap.
// - In a stream that overlaps by more, a sample is moved by a sixteenth of its stamp's deviation. A
//   gap must then exceed the jitter by half an interval. A lost sample offsets all later stamps and
//   so shows within some samples; it becomes a gap of whole intervals.
// - Samples that the computer delivered late come in a burst after an apparent gap. That gap has
//   been filled already, so they are refused: otherwise the motion would be integrated twice.
class ImuTimeline {
 public:
  static constexpr std::int64_t kMaxJitterNs = 60'000'000;  // above half of the longest interval
  static constexpr std::int64_t kDecaySamples = 1024;
  static constexpr std::int64_t kSmoothing = 16;

  void clear() { *this = ImuTimeline(); }

  // Returns whether the sample may be the next one; if not, its stamp has gone backwards.
  bool follows(const ImuSample& sample) const;

  // Returns the last stamp as received; unset before the first sample.
  GpsTime last_stamp() const { return last_stamp_; }

  // The result of place().
  struct Placement {
    bool accepted = true;     // false: the sample's time has been integrated already
    bool smoothed = false;    // the stamps jitter, so this one had a small weight
    std::int64_t gap_ns = 0;  // length of the gap before the sample
  };
  // Moves sample->time from its stamp to the sample's end on the timeline and sets its interval,
  // unless the sample is not accepted. `end` is the end of the previous sample, unset if there is
  // none.
  Placement place(GpsTime end, ImuSample* sample);

 private:
  bool comes_too_late(const ImuSample& sample, std::int64_t overlap_ns) const;

  GpsTime last_stamp_;
  std::int64_t jitter_ns_ = 0;
  std::int64_t bridged_ns_ = 0;  // the last gap, minus the samples refused since then
};

}  // namespace leonav
