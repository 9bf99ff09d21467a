#include "core/navigator/sequencer/sequencer.h"

#include <algorithm>

#include "core/gnss/orbits/satellite_state.h"
#include "core/navigator/interface/event_limiter.h"
#include "core/navigator/sequencer/input_validation.h"

namespace leonav {

Sequencer::Sequencer(const NavigatorConfig& config, StageInputs* stages)
    : config_(config),
      stages_(stages),
      inertial_(config.motion == MotionModel::kInertial),
      imu_(config),
      imu_silence_(config.realtime.epoch_interval_s),
      stamps_(config.realtime.epoch_interval_s),
      empty_epochs_(config.realtime),
      odometer_(inertial_ && config.vehicle.motion.constraints.odometer),
      work_(std::make_unique<GnssWork>()) {}

void Sequencer::on_imu(const ImuSample& received) {
  const ImuSample sample = imu_.shift_stamp(received);
  const InputFault fault = imu_.check(sample);
  if (inertial_) monitor_conventions(sample, fault);
  if (fault != InputFault::kNone) return reject_imu(fault);
  if (!inertial_) {  // nobody uses it, so its time does not matter
    ++counters_.imu;
    return;
  }
  if (const auto leapt = imu_.release_held()) {
    if (sample.time > leapt->time)
      accept_imu(*leapt);
    else
      reject_imu(InputFault::kTooFarAhead);
  }
  if (imu_.leaps(sample))
    imu_.hold(sample);
  else
    accept_imu(sample);
}

void Sequencer::monitor_conventions(const ImuSample& sample, InputFault fault) {
  if (fault == InputFault::kNone) {
    refused_imu_.add_accepted();
    stamp_offset_.add_imu(sample.time);
  } else if (fault == InputFault::kOutOfRange && is_plausible(sample.time) &&
             sample.interval_ns > 0 && sample.interval_ns <= ImuIntake::kMaxIntervalNs) {
    report_finding(refused_imu_.add_refused(sample));
  }
}

void Sequencer::accept_imu(const ImuSample& received) {
  ImuSample sample = received;
  const StampDecision stamp = imu_.evaluate_stamp(
      sample, epochs_.newest_time(), stamps_.max_ahead_ns(), stamps_.max_imu_offset_ns());
  if (stamp.fault != InputFault::kNone) return reject_imu(stamp.fault);
  if (stamp.starts_new_time) start_new_time(stamp.jump_s);
  const bool in_time =
      imu_silence_.is_in_time(sample.time, epochs_.last_time(), epochs_.newest_time());
  if (!in_time && imu_silence_.lasts()) return reject_imu(InputFault::kTimeBackwards);
  if (!lay_on_timeline(&sample)) return reject_imu(InputFault::kTimeBackwards);

  ++counters_.imu;
  imu_.accept(sample);
  if (in_time) imu_silence_.clear();
  stamps_.add_imu_sample();
  imu_.rotate_to_body(&sample);
  stages_->push_inertial(sample);
  append_to_block(sample);
  if (epochs_.has_held()) accept_epoch(epochs_.release_held());  // the IMU's time confirms it
  issue_ready_epochs();
}

bool Sequencer::lay_on_timeline(ImuSample* sample) {
  const ImuTimeline::Placement placement = imu_.lay_on_timeline(sample);
  if (!placement.accepted) return false;
  if (placement.smoothed) ++counters_.imu_smoothed;
  if (placement.gap_ns > 0 && is_event_due(++counters_.imu_gaps)) {
    emit(EventKind::kImuGap, 0, static_cast<double>(placement.gap_ns) * 1e-9);
  }
  return true;
}

// Removes everything, because it belongs to the old time, and restarts the filter. What the
// monitors have gathered compares with stamps of the old time, too.
void Sequencer::start_new_time(double jump_s) {
  emit(EventKind::kFilterReset, static_cast<std::uint8_t>(ResetCause::kTimeBase), jump_s);
  imu_.clear();
  imu_silence_.clear();
  epochs_.clear();
  stamps_.clear();
  imu_since_epoch_.clear();
  odometer_.clear();
  refused_imu_ = RefusedImuMonitor();
  stamp_offset_ = StampOffsetMonitor();
  last_issue_ = last_deadline_smoother_ = GpsTime();
  push_command({CommandKind::kRestart, 0.0, 0.0, ResetCause::kTimeBase});
}

void Sequencer::append_to_block(const ImuSample& sample) {
  if (!epochs_.last_time().is_set() && epochs_.empty()) epochs_.set_start(sample.start());
  if (sample.time <= epochs_.last_time()) return;  // an epoch was issued without waiting for it
  if (imu_since_epoch_.full())
    issue(nullptr, imu_since_epoch_.cut_of_full_block(empty_epochs_.wait_ns()));
  imu_since_epoch_.append(sample, epochs_.last_time());
}

void Sequencer::on_raw_epoch(const RawEpoch& epoch) {
  if (!is_plausible(epoch.time)) return reject_epoch(InputFault::kOutOfRange);
  if (inertial_) report_finding(stamp_offset_.add_epoch(epoch.time));
  if (epochs_.has_held()) resolve_held_epoch(epoch.time);
  if (!hold(epoch)) accept_epoch(epoch);
}

// Holds an epoch that follows an outage or has a wrong stamp, until the next one decides which.
bool Sequencer::hold(const RawEpoch& epoch) {
  if (imu_keeps_time() || !stamps_.leaps(epoch.time, epochs_.newest_time())) return false;
  epochs_.hold(epoch);
  return true;
}

void Sequencer::resolve_held_epoch(GpsTime next) {
  const RawEpoch& held = epochs_.release_held();
  if (next < held.time) return reject_epoch(InputFault::kTooFarAhead);
  if (next == held.time) return reject_epoch(InputFault::kDuplicate);  // `next` is used instead
  ++counters_.epochs;
  queue_epoch(held);
  issue_ready_epochs();
}

void Sequencer::accept_epoch(const RawEpoch& epoch) {
  const GpsTime imu_time = imu_keeps_time() ? imu_.time() : GpsTime();
  const StampDecision stamp = stamps_.evaluate(epoch.time, imu_time, epochs_.newest_time());
  if (stamp.fault != InputFault::kNone) return reject_epoch(stamp.fault);
  if (stamp.starts_new_time) {
    follow_epochs(stamp.jump_s,
                  stamp.contradicts_imu || (imu_.time().is_set() && !stamps_.confirms_imu()));
  } else if (epochs_.is_known(epoch.time)) {
    return reject_epoch(InputFault::kDuplicate);
  } else if (epochs_.is_late(epoch.time)) {
    if (!stamps_.add_late(epoch.time, imu_time, epochs_.last_raw_time()))
      return drop_late(epoch.time);
    const bool against_imu = imu_.time().is_set() && stamps_.are_apart(imu_.time(), epoch.time);
    follow_epochs(seconds_between(epoch.time, epochs_.last_time()), against_imu);
  }
  imu_.add_epoch();
  stamps_.add_good(imu_keeps_time());
  ++counters_.epochs;
  queue_epoch(epoch);
  issue_ready_epochs();
}

void Sequencer::follow_epochs(double jump_s, bool against_imu) {
  start_new_time(jump_s);
  if (against_imu) imu_.distrust();
}

// Counts a late epoch. If an empty epoch was issued for it, the wait was too short.
void Sequencer::drop_late(GpsTime time) {
  if (is_event_due(++counters_.late_epochs)) {
    emit(EventKind::kLateEpoch, 0, seconds_between(epochs_.last_time(), time));
  }
  const bool replaced =
      epochs_.last_is_empty() && imu_.time().is_set() && time > epochs_.last_raw_time();
  if (replaced) empty_epochs_.lengthen_wait(nanoseconds_between(imu_.time(), time));
}

// There is room for one epoch, because issue_ready_epochs() leaves at most kMaxPendingEpochs
// waiting.
void Sequencer::queue_epoch(const RawEpoch& epoch) {
  if (epochs_.insert(epoch) > 0) reject(InputFault::kNotSane);
  if (!inertial_) return;
  imu_silence_.add_epoch(epoch.time, imu_.time());
  if (imu_silence_.lasts()) stages_->push_inertial(TimeWithoutImu{now()});
}

void Sequencer::issue_ready_epochs() {
  for (int of_silence = 0;;) {
    const bool waiting = !epochs_.empty();
    const bool passed = waiting && (!inertial_ || epochs_.oldest().time <= imu_.time());
    if (passed) {
      imu_silence_.add_issued(true);
      issue_oldest_pending();
    } else if (const GpsTime due = time_of_due_empty_epoch(); due.is_set()) {
      issue(nullptr, due);
    } else if (waiting &&
               ((imu_silence_.lasts() && ++of_silence <= kMostAtOnce) || epochs_.is_overdue())) {
      if (is_event_due(++counters_.epochs_without_imu)) {
        emit(EventKind::kCapacity, static_cast<std::uint8_t>(SequencerCapacity::kPendingEpochs),
             static_cast<double>(next_index_));
      }
      imu_silence_.add_issued(false);
      issue_oldest_pending();
    } else {
      return;
    }
  }
}

void Sequencer::issue_oldest_pending() {
  issue(&epochs_.oldest(), epochs_.oldest().time);
  epochs_.remove_oldest();
}

GpsTime Sequencer::time_of_due_empty_epoch() const {
  if (!inertial_ || !imu_.time().is_set() || !epochs_.last_time().is_set() ||
      imu_since_epoch_.empty())
    return {};
  return empty_epochs_.due_time(imu_.time(), epochs_.last_time(), imu_since_epoch_.newest_start());
}

void Sequencer::issue(const RawEpoch* raw, GpsTime time) {
  EpochWork& work = work_->emplace<EpochWork>();
  work.index = next_index_++;
  work.time = time;
  work.empty = raw == nullptr;
  work.smoother_decided = last_deadline_smoother_.is_set() && last_deadline_smoother_ <= now();
  work.raw.time = time;
  if (raw != nullptr) work.raw = *raw;
  imu_since_epoch_.move_to_block(time, &work.block);
  odometer_.move_to_block(time, &work.odometer);
  epochs_.set_issued(time, work.empty);
  if (work.empty && is_event_due(++counters_.empty_epochs)) {
    emit(EventKind::kEmptyEpoch, 0, static_cast<double>(work.index));
  }
  if (inertial_) open_at_inertial_stage(work);
  stages_->push_gnss(*work_);
}

void Sequencer::open_at_inertial_stage(const EpochWork& work) {
  stages_->open_epoch(work.index);
  const RealtimeConfig& realtime = config_.realtime;
  last_issue_ = std::max(last_issue_, now());  // samples after a silence may be earlier
  EpochIssued issued{work.index, work.time, last_issue_.plus_seconds(realtime.deadline_ekf_s), {}};
  if (config_.estimator == Estimator::kSmoother)
    issued.deadline_smoother = last_issue_.plus_seconds(realtime.smoother_deadline_s());
  last_deadline_smoother_ = issued.deadline_smoother;
  stages_->push_inertial(issued);
}

void Sequencer::on_odometer(const OdometerIncrement& increment) {
  const InputFault fault = odometer_.add(increment, imu_.time(), epochs_.last_time());
  if (fault != InputFault::kNone) {
    ++counters_.rejected_odometer[static_cast<std::size_t>(fault)];
    return reject(fault);
  }
  ++counters_.odometer;
  counters_.late_odometer = odometer_.late();
}

template <typename Input>
void Sequencer::check_and_push(const Input& input) {
  if (const InputFault fault = check(input); fault != InputFault::kNone) return reject(fault);
  *work_ = input;
  stages_->push_gnss(*work_);
}

void Sequencer::on_klobuchar(const KlobucharModel& model) { check_and_push(model); }
void Sequencer::on_antenna(const AntennaPattern& pattern) { check_and_push(pattern); }
void Sequencer::on_checkpoint(const Checkpoint& checkpoint) { check_and_push(checkpoint); }

void Sequencer::on_ephemeris(const Ephemeris& ephemeris) {
  if (!is_valid(ephemeris.satellite) || !is_sane(ephemeris)) return reject(InputFault::kNotSane);
  ++counters_.ephemerides;
  *work_ = ephemeris;
  stages_->push_gnss(*work_);
}

// Pushes the elements of a message that are without a fault.
template <typename Inputs>
void Sequencer::push_good_ones(const Inputs& inputs) {
  auto& good = work_->emplace<Inputs>();
  for (const auto& input : inputs) {
    if (const InputFault fault = check(input); fault != InputFault::kNone) {
      reject(fault);
    } else {
      good.push_back(input);
    }
  }
  if (!good.empty()) stages_->push_gnss(*work_);
}

void Sequencer::on_precise_states(const PreciseStates& states) { push_good_ones(states); }
void Sequencer::on_corrected_states(const CorrectedStates& states) { push_good_ones(states); }
void Sequencer::on_signal_biases(const SignalBiases& biases) { push_good_ones(biases); }

void Sequencer::on_command(const Command& command) {
  if (const InputFault fault = check(command); fault != InputFault::kNone) return reject(fault);
  if (!command_limit_.allows(now())) return reject(InputFault::kTooOften);
  Command checked = command;
  checked.cause = ResetCause::kCommand;
  checked.time = now();
  push_command(checked);
}

// Pushes a restart to both stages, so that it lies between the same two epochs in both.
void Sequencer::push_command(const Command& command) {
  if (inertial_ && command.kind == CommandKind::kRestart) {
    stages_->push_inertial(Restart{command.cause});
  }
  *work_ = command;
  stages_->push_gnss(*work_);
}

void Sequencer::on_rejected(InputFault fault) { reject(fault); }

void Sequencer::on_refused(InputFault fault, std::uint64_t count) {
  const auto index = static_cast<std::size_t>(fault);
  if (index >= counters_.refused.size() || count == 0) return;
  counters_.refused[index] += count;
  if (is_event_due(counters_.refused[index])) {
    emit(EventKind::kRejectedInput, static_cast<std::uint8_t>(fault), 0.0);
  }
}

bool Sequencer::is_refusal_due(InputFault fault) const {
  const auto index = static_cast<std::size_t>(fault);
  return index < counters_.refused.size() && is_event_due(counters_.refused[index] + 1);
}

void Sequencer::reject(InputFault fault) {
  const auto index = static_cast<std::size_t>(fault);
  if (index >= counters_.rejected.size()) return;
  if (is_event_due(++counters_.rejected[index])) {
    emit(EventKind::kRejectedInput, static_cast<std::uint8_t>(fault), 0.0);
  }
}

void Sequencer::reject_imu(InputFault fault) {
  ++counters_.rejected_imu[static_cast<std::size_t>(fault)];
  reject(fault);
}

void Sequencer::reject_epoch(InputFault fault) {
  ++counters_.rejected_epochs[static_cast<std::size_t>(fault)];
  reject(fault);
}

void Sequencer::report_finding(const ConventionFinding& finding) {
  if (!finding) return;
  emit(EventKind::kConventionSuspect, static_cast<std::uint8_t>(finding.convention), finding.value);
}

void Sequencer::emit(EventKind kind, std::uint8_t code, double value) {
  stages_->event(events_.next(kind, code, value, now()));
}

GpsTime Sequencer::now() const { return imu_keeps_time() ? imu_.time() : epochs_.newest_time(); }

bool Sequencer::imu_keeps_time() const { return imu_.time().is_set() && !imu_silence_.lasts(); }

}  // namespace leonav
