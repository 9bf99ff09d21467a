#include "core/navigator/sequencer/internal/odometer_queue.h"

#include "core/navigator/sequencer/input_validation.h"

namespace leonav {

InputFault OdometerQueue::add(const OdometerIncrement& increment, GpsTime imu_time,
                              GpsTime last_epoch) {
  const InputFault fault = check(increment, kMaxSpeed, kMaxIntervalNs);
  if (fault != InputFault::kNone) return fault;
  const GpsTime time = increment.time;
  if (time == last_) return InputFault::kDuplicate;
  if (imu_time.is_set() && nanoseconds_between(time, imu_time) > kMaxAheadNs)
    return InputFault::kTooFarAhead;
  if (time < last_) {
    if (!time_monitor_.reject(time)) return InputFault::kTimeBackwards;
    waiting_.clear();
  }
  // Sums over a sliding interval would count the same distance many times.
  const bool overlaps =
      last_.is_set() && nanoseconds_between(last_, increment.start()) > increment.interval_ns / 4;
  if (overlaps && time > last_) return InputFault::kOverlap;
  time_monitor_.clear();
  if (const InputFault full = place(increment, last_epoch); full != InputFault::kNone) return full;
  last_ = time;
  return InputFault::kNone;
}

InputFault OdometerQueue::place(const OdometerIncrement& increment, GpsTime last_epoch) {
  if (!used_) return InputFault::kNone;
  if (last_epoch.is_set() && nanoseconds_between(last_epoch, increment.time) > kMaxLatencyNs) {
    ++late_;
    return InputFault::kNone;
  }
  if (waiting_.full()) return InputFault::kTooMany;
  waiting_.push_back(increment);
  return InputFault::kNone;
}

void OdometerQueue::move_to_block(GpsTime time, OdometerBlock* block) {
  for (; !waiting_.empty() && waiting_.front().time <= time; waiting_.pop_front())
    block->push_back(waiting_.front());
}

void OdometerQueue::clear() {
  waiting_.clear();
  time_monitor_.clear();
  last_ = GpsTime();
}

}  // namespace leonav
