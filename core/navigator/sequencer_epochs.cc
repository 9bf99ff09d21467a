// Raw epochs, in Sequencer: put in order, held until the IMU has passed them, issued.
#include <algorithm>
#include <utility>

#include "core/navigator/input_checks.h"
#include "core/navigator/sequencer.h"
#include "core/navigator/sequencer_rules.h"

namespace leonav {

void Sequencer::on_raw_epoch(const RawEpoch& epoch) {
  if (!is_plausible(epoch.time)) return reject(InputFault::kOutOfRange);
  if (inertial_) tell(stamp_offset_.add_epoch(epoch.time));
  if (is_held_) judge_held(epoch.time);
  if (!hold(epoch)) place_epoch(epoch);
}

// Keeps an epoch that comes after an outage, or has a wild stamp, until the next one tells which.
bool Sequencer::hold(const RawEpoch& epoch) {
  const GpsTime newest = newest_epoch_time();
  if (!gnss_keeps_time() || !newest.is_set()) return false;
  if (nanoseconds_between(epoch.time, newest) <= max_epoch_ahead_ns_) return false;
  *held_ = epoch;
  is_held_ = true;
  return true;
}

void Sequencer::judge_held(GpsTime next) {
  is_held_ = false;
  if (next < held_->time) return reject(InputFault::kTooFarAhead);
  if (next == held_->time) return reject(InputFault::kDuplicate);  // `next` takes its place
  ++counters_.epochs;
  queue_epoch(*held_);
  issue_ready_epochs();
}

void Sequencer::place_epoch(const RawEpoch& epoch) {
  const InputFault fault = check_epoch_time(epoch.time);
  if (fault != InputFault::kNone) return reject(fault);
  if (epoch.time <= last_epoch_time_) return drop_late(epoch.time);
  epoch_watch_.clear();
  ++counters_.epochs;
  queue_epoch(epoch);
  issue_ready_epochs();
}

// Where an empty epoch took its place, the wait was too short: a quarter more than this latency
// from now on, for latencies vary.
void Sequencer::drop_late(GpsTime time) {
  if (worth_an_event(++counters_.late_epochs)) {
    emit(EventKind::kLateEpoch, 0, seconds_between(last_epoch_time_, time));
  }
  const bool replaced = last_epoch_is_empty_ && imu_time_.is_set() && time > last_raw_epoch_time_;
  if (!replaced) return;
  const std::int64_t latency_ns = nanoseconds_between(imu_time_, time);
  gnss_wait_ns_ = std::max(gnss_wait_ns_, std::min(latency_ns + latency_ns / 4, kMaxGnssLatencyNs));
}

// kNone also for an epoch that is merely late; the caller tells.
InputFault Sequencer::check_epoch_time(GpsTime time) {
  const GpsTime reference = std::max(imu_time_, newest_epoch_time());
  if (!reference.is_set()) return InputFault::kNone;
  const std::int64_t ahead_ns = nanoseconds_between(time, reference);
  if (ahead_ns > max_epoch_ahead_ns_ || ahead_ns < -kMaxAheadNs) {
    if (!epoch_watch_.reject(time)) {
      return ahead_ns > 0 ? InputFault::kTooFarAhead : InputFault::kTimeBackwards;
    }
    change_time_base(seconds_between(time, reference));
    return InputFault::kNone;
  }
  return is_known(time) ? InputFault::kDuplicate : InputFault::kNone;
}

bool Sequencer::is_known(GpsTime time) const {
  const auto end = pending_.begin() + static_cast<std::ptrdiff_t>(pending_count_);
  return (time == last_epoch_time_ && !last_epoch_is_empty_) ||
         std::any_of(pending_.begin(), end, [&](const auto& slot) { return slot->time == time; });
}

void Sequencer::queue_epoch(const RawEpoch& epoch) {
  // issue_ready_epochs() leaves at most kMaxPendingEpochs waiting, so there is room for one.
  const std::size_t left_out = copy_sane(epoch, pending_[pending_count_].get());
  for (std::size_t i = pending_count_; i > 0 && epoch.time < pending_[i - 1]->time; --i) {
    std::swap(pending_[i], pending_[i - 1]);
  }
  ++pending_count_;
  if (left_out > 0) reject(InputFault::kNotSane);
}

void Sequencer::issue_ready_epochs() {
  for (;;) {
    const bool waiting = pending_count_ > 0;
    const bool passed = waiting && (!inertial_ || pending_[0]->time <= imu_time_);
    if (passed) {
      issue_oldest_pending();
    } else if (const GpsTime due = time_of_due_empty_epoch(); due.is_set()) {
      issue(nullptr, due);
    } else if (waited_long_enough()) {
      if (worth_an_event(++counters_.epochs_without_imu)) {
        emit(EventKind::kCapacity, static_cast<std::uint8_t>(SequencerCapacity::kPendingEpochs),
             static_cast<double>(next_index_));
      }
      issue_oldest_pending();
    } else {
      return;
    }
  }
}

// The IMU is late, or has stopped.
bool Sequencer::waited_long_enough() const {
  if (pending_count_ > kMaxPendingEpochs) return true;
  if (pending_count_ <= kMinPending) return false;
  const GpsTime newest = pending_[pending_count_ - 1]->time;
  return nanoseconds_between(newest, pending_[0]->time) > kMaxImuLatencyNs;
}

void Sequencer::issue_oldest_pending() {
  issue(pending_[0].get(), pending_[0]->time);
  std::rotate(pending_.begin(), pending_.begin() + 1,
              pending_.begin() + static_cast<std::ptrdiff_t>(pending_count_));
  --pending_count_;
}

GpsTime Sequencer::time_of_due_empty_epoch() const {
  if (!inertial_ || !imu_time_.is_set() || !last_epoch_time_.is_set() || tail_.empty()) return {};
  const std::int64_t since_ns = nanoseconds_between(imu_time_, last_epoch_time_);
  const std::int64_t wait_ns = epoch_interval_ns_ + gnss_wait_ns_;
  if (since_ns < wait_ns) return {};
  const GpsTime nominal = last_epoch_time_.plus_nanoseconds(epoch_interval_ns_);
  // Only a hole gets this far ahead. One epoch bridges it, not a burst of them.
  const GpsTime hole_end = tail_.back().start();
  const bool hole = since_ns > 2 * wait_ns && hole_end > last_epoch_time_;
  return hole ? hole_end : nominal;
}

void Sequencer::issue(const RawEpoch* raw, GpsTime time) {
  EpochWork& work = work_->emplace<EpochWork>();
  work.index = next_index_++;
  work.time = time;
  work.empty = raw == nullptr;
  work.raw.time = time;
  if (raw != nullptr) work.raw = *raw;
  while (!tail_.empty() && tail_.front().start() < time) {
    if (tail_.front().time > time) {
      const ImuSplit parts = split(tail_.front(), time);
      work.block.push_back(parts.before);
      tail_.front() = parts.after;
      break;
    }
    work.block.push_back(tail_.front());
    tail_.pop_front();
  }
  odometer_.hand_over(time, &work.odometer);
  last_epoch_time_ = time;
  last_epoch_is_empty_ = work.empty;
  if (!work.empty) last_raw_epoch_time_ = time;
  if (work.empty) {
    ++counters_.empty_epochs;
    if (worth_an_event(counters_.empty_epochs)) {
      emit(EventKind::kEmptyEpoch, 0, static_cast<double>(work.index));
    }
  }
  if (inertial_) {
    stages_->open_epoch(work.index);
    const RealtimeConfig& realtime = config_.realtime;
    EpochIssued issued{work.index, time, imu_time_.plus_seconds(realtime.deadline_ekf_s), {}};
    if (config_.estimator == Estimator::kSmoother)
      issued.deadline_smoother =
          imu_time_.plus_seconds(std::max(realtime.deadline_ekf_s, realtime.deadline_smoother_s));
    stages_->push_inertial(issued);
  }
  stages_->push_gnss(*work_);
}

}  // namespace leonav
