#include "core/navigator/sequencer/internal/imu_timeline.h"

#include <algorithm>

namespace leonav {

bool ImuTimeline::follows(const ImuSample& sample) const {
  if (!last_stamp_.is_set()) return true;
  const std::int64_t back_ns = nanoseconds_between(last_stamp_, sample.time);
  return back_ns <= std::max(sample.interval_ns / 2, jitter_ns_);
}

bool ImuTimeline::comes_too_late(const ImuSample& sample, std::int64_t overlap_ns) const {
  // Samples come more often than their intervals allow.
  if (overlap_ns > kMaxJitterNs + sample.interval_ns) return true;
  const std::int64_t usual_ns = std::max(sample.interval_ns / 4, jitter_ns_);
  return bridged_ns_ >= sample.interval_ns && overlap_ns > usual_ns;
}

ImuTimeline::Placement ImuTimeline::place(GpsTime end, ImuSample* sample) {
  Placement place;
  const GpsTime previous_stamp = last_stamp_;
  last_stamp_ = sample->time;
  if (!end.is_set() || !previous_stamp.is_set()) return place;
  const std::int64_t interval_ns = sample->interval_ns, half_ns = interval_ns / 2;
  const std::int64_t late_ns = nanoseconds_between(sample->time, end) - interval_ns;
  if (comes_too_late(*sample, -late_ns)) {
    bridged_ns_ -= std::min(bridged_ns_, interval_ns);
    place.accepted = false;
    return place;
  }
  jitter_ns_ = std::max(jitter_ns_ - jitter_ns_ / kDecaySamples, std::min(-late_ns, kMaxJitterNs));
  place.smoothed = jitter_ns_ > half_ns;
  if (late_ns > jitter_ns_ + half_ns) {
    place.gap_ns = place.smoothed ? (late_ns + half_ns) / interval_ns * interval_ns : late_ns;
  } else if (place.smoothed) {
    sample->interval_ns += std::clamp(late_ns / kSmoothing, -half_ns, half_ns);
  } else {
    sample->interval_ns += late_ns;
  }
  sample->time = end.plus_nanoseconds(place.gap_ns + sample->interval_ns);
  bridged_ns_ = place.gap_ns;
  return place;
}

}  // namespace leonav
