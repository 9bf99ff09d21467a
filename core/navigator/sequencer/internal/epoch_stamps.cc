#include "core/navigator/sequencer/internal/epoch_stamps.h"

#include <algorithm>
#include <cmath>

#include "core/navigator/sequencer/internal/empty_epoch_schedule.h"
#include "core/navigator/sequencer/internal/interval.h"

namespace leonav {

EpochStamps::EpochStamps(double epoch_interval_s)
    : max_ahead_ns_(std::max(kMaxStampAheadNs,
                             interval_in_nanoseconds(kMaxAheadIntervals * epoch_interval_s))),
      max_imu_offset_ns_(EmptyEpochSchedule::kMaxGnssLatencyNs +
                         interval_in_nanoseconds(1.5 * epoch_interval_s)),
      run_with_imu_(std::max(
          kRunWithImu,
          static_cast<int>(kImuSilenceNs / interval_in_nanoseconds(epoch_interval_s)) + 2)),
      rejected_(kRunToRestart, interval_in_nanoseconds(kMaxStepS)),
      late_(kRunToRestart, interval_in_nanoseconds(kMaxStepS)),
      far_from_imu_(interval_in_nanoseconds(kMaxStepS), EmptyEpochSchedule::kMaxGnssLatencyNs),
      late_for_imu_(interval_in_nanoseconds(kMaxStepS), EmptyEpochSchedule::kMaxGnssLatencyNs) {}

bool EpochStamps::are_apart(GpsTime imu_time, GpsTime epoch) const {
  return std::abs(nanoseconds_between(imu_time, epoch)) > max_imu_offset_ns_;
}

bool EpochStamps::leaps(GpsTime time, GpsTime newest_epoch) const {
  return newest_epoch.is_set() && nanoseconds_between(time, newest_epoch) > max_ahead_ns_;
}

StampDecision EpochStamps::evaluate(GpsTime time, GpsTime imu_time, GpsTime newest_epoch) {
  // Where IMU samples come between the epochs, these cannot lead the time away from them.
  const bool imu_runs = imu_time.is_set() && imu_time != imu_time_at_last_;
  imu_time_at_last_ = imu_time;
  const GpsTime reference = imu_runs ? imu_time : std::max(imu_time, newest_epoch);
  if (!reference.is_set()) return {};
  const std::int64_t ahead_ns = nanoseconds_between(time, reference);
  const bool imu_counts = imu_time.is_set() && confirms_imu_;
  const bool continues_run = !imu_counts && rejected_.run() > 0 &&
                             nanoseconds_between(newest_epoch, time) > max_imu_offset_ns_;
  if (ahead_ns <= max_ahead_ns_ && ahead_ns >= -kMaxStampAheadNs && !continues_run) return {};
  const double jump_s = seconds_between(time, reference);
  const bool is_run = rejected_.reject(time);
  if (imu_counts && imu_runs) {
    far_from_imu_.add(time, imu_time);
    if (far_from_imu_.run() >= kRunToRestart && far_from_imu_.run_ns() > kMaxContradictionNs)
      return {InputFault::kNone, true, jump_s, true};
  }
  const bool may_be_backlog = ahead_ns < 0 && rejected_.run_ns() <= kMaxBacklogNs;
  if (!is_run || (imu_counts && (rejected_.run() < run_with_imu_ || may_be_backlog)))
    return {ahead_ns > 0 ? InputFault::kTooFarAhead : InputFault::kTimeBackwards};
  return {InputFault::kNone, true, jump_s};
}

bool EpochStamps::add_late(GpsTime time, GpsTime imu_time, GpsTime last_issued) {
  if (imu_time.is_set() && are_apart(imu_time, time)) {
    late_.clear();
    late_for_imu_.add(time, imu_time);
    return late_for_imu_.run() >= (confirms_imu_ ? run_with_imu_ : kRunToRestart) &&
           late_for_imu_.run_ns() > (confirms_imu_ ? kImuSilenceNs : kLateRunNs);
  }
  late_for_imu_.clear();
  if (imu_time.is_set() && time > last_issued) {  // GNSS is slow: only empty ones are later
    late_.clear();
    return false;
  }
  return late_.reject(time) && late_.run_ns() > kLateRunNs;
}

void EpochStamps::add_good(bool imu_keeps_time) {
  end_runs();
  if (imu_keeps_time) confirms_imu_ = true;
}

void EpochStamps::add_imu_sample() {
  if (confirms_imu_) rejected_.clear();
}

void EpochStamps::clear() {
  end_runs();
  imu_time_at_last_ = GpsTime();
  confirms_imu_ = false;
}

void EpochStamps::end_runs() {
  rejected_.clear();
  late_.clear();
  far_from_imu_.clear();
  late_for_imu_.clear();
}

}  // namespace leonav
