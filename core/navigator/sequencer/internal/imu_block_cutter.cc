#include "core/navigator/sequencer/internal/imu_block_cutter.h"

#include <algorithm>

namespace leonav {

void ImuBlockCutter::append(const ImuSample& sample, GpsTime last_epoch) {
  const bool across = sample.start() < last_epoch;
  samples_.push_back(across ? split(sample, last_epoch).after : sample);
}

GpsTime ImuBlockCutter::cut_of_full_block(std::int64_t wait_ns) const {
  const GpsTime latest = samples_.back().time.plus_nanoseconds(-wait_ns);
  return std::max(latest, samples_[samples_.size() / 4].time);
}

void ImuBlockCutter::move_to_block(GpsTime time, ImuBlock* block) {
  while (!samples_.empty() && samples_.front().start() < time) {
    if (samples_.front().time > time) {
      const ImuSplit parts = split(samples_.front(), time);
      block->push_back(parts.before);
      samples_.front() = parts.after;
      break;
    }
    block->push_back(samples_.front());
    samples_.pop_front();
  }
}

}  // namespace leonav
