#include "core/navigator/sequencer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/earth/rotation.h"
#include "core/gnss/satellite_state.h"
#include "core/navigator/input_checks.h"

namespace leonav {
namespace {

constexpr auto kMaxAheadNs =
    static_cast<std::int64_t>(Sequencer::kMaxAheadS) * kNanosecondsPerSecond;

std::int64_t nanoseconds_between(GpsTime a, GpsTime b) { return a.nanoseconds() - b.nanoseconds(); }

// A stream that errs at every message must not drown the events; the counters have the number.
bool worth_an_event(std::uint64_t count) { return count <= 16 || count % 256 == 0; }

std::int64_t interval_in_nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::llround(std::max(seconds, 0.05) * 1e9));
}

}  // namespace

Sequencer::Sequencer(const NavigatorConfig& config, StageInputs* stages)
    : config_(config),
      stages_(stages),
      inertial_(config.motion == MotionModel::kInertial),
      C_b_imu_(
          rotation_from_euler({config.vehicle.mounting_rpy.x(), config.vehicle.mounting_rpy.y(),
                               config.vehicle.mounting_rpy.z()})),
      mounting_is_identity_(config.vehicle.mounting_rpy.isZero(0.0)),
      imu_offset_ns_(static_cast<std::int64_t>(std::llround(config.imu_time_offset_s * 1e9))),
      epoch_interval_ns_(interval_in_nanoseconds(config.realtime.epoch_interval_s)),
      max_epoch_ahead_ns_(
          std::max(kMaxAheadNs,
                   interval_in_nanoseconds(kMaxAheadIntervals * config.realtime.epoch_interval_s))),
      gnss_wait_ns_(std::max(
          epoch_interval_ns_ / 2,
          static_cast<std::int64_t>(std::llround(config.realtime.gnss_latency_allowance_s * 1e9)))),
      imu_watch_(kImuRunToRestart, kMaxImuStepNs),
      epoch_watch_(kEpochRunToRestart, interval_in_nanoseconds(kMaxEpochStepS)),
      held_(std::make_unique<RawEpoch>()),
      tail_(kMaxImuBlock),
      odometer_(inertial_ && config.vehicle.motion.constraints.odometer),
      work_(std::make_unique<GnssWork>()) {
  for (auto& slot : pending_) slot = std::make_unique<RawEpoch>();
}

void Sequencer::on_imu(const ImuSample& received) {
  const ImuLimits limits{kMaxRotationRate, kMaxSpecificForce, kMaxImuIntervalNs};
  ImuSample sample = received;
  sample.time = received.time.plus_nanoseconds(imu_offset_ns_);
  const InputFault fault = check(sample, limits);
  if (inertial_) watch_conventions(sample, fault);
  if (fault != InputFault::kNone) return reject(fault);
  if (const auto leapt = std::exchange(leapt_imu_, std::nullopt)) {
    if (sample.time > leapt->time)
      accept_imu(*leapt);
    else
      reject(InputFault::kTooFarAhead);
  }
  if (leaps(sample))
    leapt_imu_ = sample;
  else
    accept_imu(sample);
}

void Sequencer::watch_conventions(const ImuSample& sample, InputFault fault) {
  if (fault == InputFault::kNone) {
    refused_imu_.add_accepted();
    stamp_offset_.add_imu(sample.time);
  } else if (fault == InputFault::kOutOfRange && is_plausible(sample.time) &&
             sample.interval_ns > 0 && sample.interval_ns <= kMaxImuIntervalNs) {
    tell(refused_imu_.add_refused(sample));
  }
}

// A hole in the stream, or one wild stamp: the next sample tells.
bool Sequencer::leaps(const ImuSample& sample) const {
  const GpsTime last_stamp = imu_stamps_.last_stamp();
  if (!last_stamp.is_set()) return false;
  const std::int64_t ahead_ns = nanoseconds_between(sample.time, last_stamp);
  return ahead_ns > kImuLeapNs && ahead_ns <= kMaxAheadNs;
}

void Sequencer::accept_imu(const ImuSample& received) {
  ImuSample sample = received;
  const InputFault fault = place_imu(&sample);
  if (fault != InputFault::kNone) return reject(fault);

  ++counters_.imu;
  imu_watch_.clear();
  imu_time_ = sample.time;
  if (!inertial_) return;
  epoch_watch_.clear();  // the IMU keeps time: GNSS alone cannot change it
  if (!mounting_is_identity_) {
    sample.delta_theta_b = C_b_imu_ * sample.delta_theta_b;
    sample.delta_velocity_b = C_b_imu_ * sample.delta_velocity_b;
  }
  stages_->push_inertial(sample);
  extend_tail(sample);
  if (std::exchange(is_held_, false)) place_epoch(*held_);  // the IMU's time tells
  issue_ready_epochs();
}

// Decides whether the sample fits behind the last one and lays it there.
InputFault Sequencer::place_imu(ImuSample* sample) {
  const GpsTime last_stamp = imu_stamps_.last_stamp();
  if (last_stamp.is_set()) {
    if (sample->time == last_stamp) return InputFault::kDuplicate;
    const GpsTime newest = std::max(last_stamp, newest_epoch_time());
    const bool backwards = !imu_stamps_.follows(*sample);
    if (backwards || nanoseconds_between(sample->time, newest) > kMaxAheadNs) {
      if (!imu_watch_.reject(sample->time)) {
        return backwards ? InputFault::kTimeBackwards : InputFault::kTooFarAhead;
      }
      change_time_base(seconds_between(sample->time, last_stamp));
    }
  }
  const ImuStamps::Place place = imu_stamps_.place(imu_time_, sample);
  if (!place.accepted) return InputFault::kTimeBackwards;
  if (place.smoothed) ++counters_.imu_smoothed;
  if (place.hole_ns > 0 && worth_an_event(++counters_.imu_gaps)) {
    emit(EventKind::kImuGap, 0, static_cast<double>(place.hole_ns) * 1e-9);
  }
  return InputFault::kNone;
}

// Everything kept belongs to the old time: it goes, and the filter starts over.
void Sequencer::change_time_base(double jump_s) {
  emit(EventKind::kFilterReset, static_cast<std::uint8_t>(ResetCause::kTimeBase), jump_s);
  imu_time_ = GpsTime();
  imu_stamps_.clear();
  leapt_imu_.reset();
  last_epoch_time_ = last_raw_epoch_time_ = GpsTime();
  last_epoch_is_empty_ = true;
  pending_count_ = 0;
  is_held_ = false;
  tail_.clear();
  imu_watch_.clear();
  epoch_watch_.clear();
  odometer_.clear();
  push_command({CommandKind::kRestart, 0.0, 0.0, ResetCause::kTimeBase});
}

void Sequencer::extend_tail(const ImuSample& sample) {
  if (!last_epoch_time_.is_set() && pending_count_ == 0) last_epoch_time_ = sample.start();
  if (sample.time <= last_epoch_time_) return;  // an epoch was issued without waiting for it
  if (tail_.full()) issue(nullptr, cut_of_full_block());
  const bool across = sample.start() < last_epoch_time_;
  tail_.push_back(across ? split(sample, last_epoch_time_).after : sample);
}

void Sequencer::on_odometer(const OdometerIncrement& increment) {
  const InputFault fault = odometer_.add(increment, imu_time_, last_epoch_time_);
  if (fault != InputFault::kNone) return reject(fault);
  ++counters_.odometer;
  counters_.late_odometer = odometer_.late();
}

// Leaves room for an epoch under way, as far as a quarter of the block makes room enough.
GpsTime Sequencer::cut_of_full_block() const {
  const GpsTime latest = tail_.back().time.plus_nanoseconds(-gnss_wait_ns_);
  return std::max(latest, tail_[tail_.size() / 4].time);
}

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

void Sequencer::on_ephemeris(const Ephemeris& ephemeris) {
  if (!is_valid(ephemeris.satellite) || !is_sane(ephemeris)) return reject(InputFault::kNotSane);
  ++counters_.ephemerides;
  *work_ = ephemeris;
  stages_->push_gnss(*work_);
}

void Sequencer::on_precise_states(const PreciseStates& states) {
  auto& good = work_->emplace<PreciseStates>();
  for (const PreciseState& state : states) {
    if (const InputFault fault = check(state); fault != InputFault::kNone) {
      reject(fault);
    } else {
      good.push_back(state);
    }
  }
  if (!good.empty()) stages_->push_gnss(*work_);
}

void Sequencer::on_klobuchar(const KlobucharModel& model) {
  if (const InputFault fault = check(model); fault != InputFault::kNone) return reject(fault);
  *work_ = model;
  stages_->push_gnss(*work_);
}

void Sequencer::on_antenna(const AntennaPattern& pattern) {
  if (const InputFault fault = check(pattern); fault != InputFault::kNone) return reject(fault);
  *work_ = pattern;
  stages_->push_gnss(*work_);
}

void Sequencer::on_command(const Command& command) {
  if (const InputFault fault = check(command); fault != InputFault::kNone) return reject(fault);
  push_command({command.kind, command.value, command.sigma, ResetCause::kCommand});
}

// A restart lies between the same two epochs in the work of both stages.
void Sequencer::push_command(const Command& command) {
  if (inertial_ && command.kind == CommandKind::kRestart) {
    stages_->push_inertial(Restart{command.cause});
  }
  *work_ = command;
  stages_->push_gnss(*work_);
}

void Sequencer::on_rejected(InputFault fault) { reject(fault); }

void Sequencer::reject(InputFault fault) {
  const auto index = static_cast<std::size_t>(fault);
  if (index >= counters_.rejected.size()) return;
  if (worth_an_event(++counters_.rejected[index])) {
    emit(EventKind::kRejectedInput, static_cast<std::uint8_t>(fault), 0.0);
  }
}

void Sequencer::tell(const ConventionFinding& finding) {
  if (!finding) return;
  emit(EventKind::kConventionSuspect, static_cast<std::uint8_t>(finding.convention), finding.value);
}

GpsTime Sequencer::newest_epoch_time() const {
  return pending_count_ > 0 ? pending_[pending_count_ - 1]->time : last_epoch_time_;
}

void Sequencer::emit(EventKind kind, std::uint8_t code, double value) {
  const GpsTime time = imu_time_.is_set() ? imu_time_ : newest_epoch_time();
  stages_->event(events_.next(kind, code, value, time));
}

}  // namespace leonav
