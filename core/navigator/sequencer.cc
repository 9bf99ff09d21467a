#include "core/navigator/sequencer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/earth/rotation.h"
#include "core/gnss/satellite_state.h"
#include "core/navigator/input_checks.h"
#include "core/navigator/sequencer_rules.h"

namespace leonav {
namespace {

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

void Sequencer::on_checkpoint(const Checkpoint& checkpoint) {
  if (const InputFault fault = check(checkpoint); fault != InputFault::kNone) return reject(fault);
  *work_ = checkpoint;
  stages_->push_gnss(*work_);
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
