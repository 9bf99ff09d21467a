// The ImuTimeline lays IMU samples end to end although their stamps jitter.
#pragma once
#include <cstdint>

#include "core/inertial/strapdown/imu.h"

namespace leonav {

// A stamp is early or late against where the sample would lie if it followed the previous one with
// its own interval. Only jitter makes a sample start before the previous one's end, so the largest
// recent overlap measures the jitter:
// - In a stream that overlaps by no more than half an interval, stamps are used as they are: a
//   sample starts at the previous one's end and ends at its stamp. If it is later than half an
//   interval and the jitter, it lies after a hole.
// - In a stream that overlaps by more, a sample is moved by a sixteenth of its stamp's deviation. A
//   hole must then exceed the jitter by half an interval. A lost sample offsets all stamps after it
//   and so shows within some samples; it becomes a hole of whole intervals.
// - Samples that a host held up come in a burst after an apparent hole. That hole has been bridged
//   already, so they come too late and are refused: integrated too, the motion would count twice.
class ImuTimeline {
 public:
  static constexpr std::int64_t kMaxJitterNs = 60'000'000;  // above half of the longest interval
  static constexpr std::int64_t kDecaySamples = 1024;
  static constexpr std::int64_t kSmoothing = 16;

  void clear() { *this = ImuTimeline(); }

  // The sample may be the next one; if not, its stamp has gone backwards.
  bool follows(const ImuSample& sample) const;

  // As received; unset before the first sample.
  GpsTime last_stamp() const { return last_stamp_; }

  struct Placement {
    bool accepted = true;      // false: the time of the sample has been counted already
    bool smoothed = false;     // the stamp had little weight
    std::int64_t hole_ns = 0;  // before the sample
  };
  // `end`: of the previous sample, unset if there is none. Moves sample->time from its stamp to
  // where the sample ends and sets its interval, unless it is not accepted.
  Placement place(GpsTime end, ImuSample* sample);

 private:
  bool comes_too_late(const ImuSample& sample, std::int64_t overlap_ns) const;

  GpsTime last_stamp_;
  std::int64_t jitter_ns_ = 0;
  std::int64_t bridged_ns_ = 0;  // the hole just before, less the samples refused since
};

}  // namespace leonav
