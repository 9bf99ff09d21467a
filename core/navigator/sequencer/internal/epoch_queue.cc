#include "core/navigator/sequencer/internal/epoch_queue.h"

#include <algorithm>
#include <utility>

#include "core/navigator/sequencer/input_validation.h"
#include "core/navigator/sequencer/internal/empty_epoch_schedule.h"
#include "core/navigator/sequencer/internal/interval.h"

namespace leonav {

EpochQueue::EpochQueue(double epoch_interval_s)
    : max_ahead_ns_(std::max(kMaxStampAheadNs,
                             interval_in_nanoseconds(kMaxAheadIntervals * epoch_interval_s))),
      max_imu_offset_ns_(EmptyEpochSchedule::kMaxGnssLatencyNs +
                         interval_in_nanoseconds(1.5 * epoch_interval_s)),
      run_with_imu_(std::max(
          kRunWithImu,
          static_cast<int>(kImuSilenceNs / interval_in_nanoseconds(epoch_interval_s)) + 2)),
      time_monitor_(kRunToRestart, interval_in_nanoseconds(kMaxStepS)),
      late_monitor_(kRunToRestart, interval_in_nanoseconds(kMaxStepS)),
      held_(std::make_unique<RawEpoch>()) {
  for (auto& slot : pending_) slot = std::make_unique<RawEpoch>();
}

StampDecision EpochQueue::evaluate(GpsTime time, GpsTime imu_time) {
  // Where IMU samples come between the epochs, these cannot lead the time away from them.
  const bool imu_runs = imu_time.is_set() && imu_time != imu_time_at_last_;
  imu_time_at_last_ = imu_time;
  const GpsTime reference = imu_runs ? imu_time : std::max(imu_time, newest_time());
  if (!reference.is_set()) return {};
  const std::int64_t ahead_ns = nanoseconds_between(time, reference);
  const bool imu_counts = imu_time.is_set() && confirms_imu_;
  const bool continues_run = !imu_counts && time_monitor_.run() > 0 && time < newest_time();
  if (ahead_ns > max_ahead_ns_ || ahead_ns < -kMaxStampAheadNs || continues_run) {
    const bool is_run = time_monitor_.reject(time);
    if (!is_run || (imu_counts && time_monitor_.run() < run_with_imu_)) {
      return {ahead_ns > 0 ? InputFault::kTooFarAhead : InputFault::kTimeBackwards};
    }
    return {InputFault::kNone, true, seconds_between(time, reference)};
  }
  return {is_known(time) ? InputFault::kDuplicate : InputFault::kNone};
}

bool EpochQueue::leaps(GpsTime time) const {
  const GpsTime newest = newest_time();
  return newest.is_set() && nanoseconds_between(time, newest) > max_ahead_ns_;
}

bool EpochQueue::is_known(GpsTime time) const {
  const auto end = pending_.begin() + static_cast<std::ptrdiff_t>(count_);
  return (time == last_time_ && !last_is_empty_) ||
         std::any_of(pending_.begin(), end, [&](const auto& slot) { return slot->time == time; });
}

std::size_t EpochQueue::insert(const RawEpoch& epoch) {
  const std::size_t left_out = copy_valid_observations(epoch, pending_[count_].get());
  for (std::size_t i = count_; i > 0 && epoch.time < pending_[i - 1]->time; --i) {
    std::swap(pending_[i], pending_[i - 1]);
  }
  ++count_;
  return left_out;
}

void EpochQueue::remove_oldest() {
  std::rotate(pending_.begin(), pending_.begin() + 1,
              pending_.begin() + static_cast<std::ptrdiff_t>(count_));
  --count_;
}

bool EpochQueue::is_overdue() const {
  if (count_ > kMaxPendingEpochs) return true;
  if (count_ <= kMinPending) return false;
  const GpsTime newest = pending_[count_ - 1]->time;
  return nanoseconds_between(newest, pending_[0]->time) > kMaxImuLatencyNs;
}

bool EpochQueue::are_apart(GpsTime imu_time, GpsTime epoch) const {
  return std::abs(nanoseconds_between(imu_time, epoch)) > max_imu_offset_ns_;
}

bool EpochQueue::add_late(GpsTime time, GpsTime imu_time) {
  const bool against_imu = imu_time.is_set() && are_apart(imu_time, time);
  // Else GNSS is slow, and only empty epochs have been issued.
  const bool against_epochs = time <= last_raw_time_;
  if (imu_time.is_set() && !against_imu && !against_epochs) return false;
  const bool is_run = late_monitor_.reject(time);
  if (against_imu && confirms_imu_)
    return late_monitor_.run() >= run_with_imu_ && late_monitor_.run_ns() > kImuSilenceNs;
  return is_run && late_monitor_.run_ns() > kLateRunNs;
}

GpsTime EpochQueue::newest_time() const {
  return count_ > 0 ? pending_[count_ - 1]->time : last_time_;
}

void EpochQueue::hold(const RawEpoch& epoch) {
  *held_ = epoch;
  has_held_ = true;
}

const RawEpoch& EpochQueue::release_held() {
  has_held_ = false;
  return *held_;
}

void EpochQueue::set_issued(GpsTime time, bool empty) {
  last_time_ = time;
  last_is_empty_ = empty;
  if (!empty) last_raw_time_ = time;
}

void EpochQueue::clear() {
  last_time_ = last_raw_time_ = GpsTime();
  last_is_empty_ = true;
  imu_time_at_last_ = GpsTime();
  count_ = 0;
  has_held_ = confirms_imu_ = false;
  time_monitor_.clear();
  late_monitor_.clear();
}

}  // namespace leonav
