#include "core/navigator/stages/inertial_navigator.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/base/duration.h"

namespace leonav {
namespace {

constexpr double kLongestGap_s = 10.0;  // after a longer gap the old solution is useless
constexpr double kJumpEvent_m = 1.0;

}  // namespace

InertialNavigator::InertialNavigator(const NavigatorConfig& config,
                                     TimedMailbox<Anchor>* ekf_mailbox,
                                     TimedMailbox<SmootherAnchor>* smoother_mailbox,
                                     OutputSink* sink)
    : sink_(sink),
      events_(Stage::kInertial, sink),
      solution_period_ns_(
          config.solution_rate_hz > 0.0 ? rounded_nanoseconds(1.0 / config.solution_rate_hz) : 0),
      ins_only_after_ns_(rounded_nanoseconds(config.realtime.ins_only_after_s() +
                                             config.realtime.gnss_latency_allowance_s +
                                             config.realtime.deadline_ekf_s)),
      decisions_(ekf_mailbox, smoother_mailbox, sink, &events_),
      propagation_(config) {}

void InertialNavigator::process(const InertialWork& work) {
  if (const auto* sample = std::get_if<ImuSample>(&work)) {
    on_sample(*sample);
  } else if (const auto* epoch = std::get_if<EpochIssued>(&work)) {
    on_epoch(*epoch);
  } else if (const auto* restart = std::get_if<Restart>(&work)) {
    on_restart(*restart);
  } else if (const auto* data = std::get_if<TimeWithoutImu>(&work)) {
    on_time_without_imu(data->time);
  }
}

void InertialNavigator::on_epoch(const EpochIssued& issued) {
  // There is no room where the IMU has stopped, so that no deadline is ever reached.
  if (auto oldest = decisions_.make_room()) {
    events_.emit(EventKind::kCapacity, static_cast<std::uint8_t>(InertialCapacity::kWaiting),
                 static_cast<double>(oldest->issued.index), data_time_);
    decide(&*oldest, data_time_, true);
  }
  decisions_.push(issued);
}

void InertialNavigator::on_sample(const ImuSample& sample) {
  const bool follows_gap =
      data_time_.is_set() && seconds_between(sample.start(), data_time_) > kLongestGap_s;
  if (sample.time <= imu_time_ || follows_gap) start_over(sample.time);
  imu_time_ = sample.time;
  data_time_ = std::max(data_time_, sample.time);
  propagation_.add_sample(sample);
  decide_due_epochs(sample.time);
  source_ = source_at(sample.time);
  publish_newest(sample.time);
}

void InertialNavigator::on_time_without_imu(GpsTime time) {
  if (time <= data_time_) return;
  data_time_ = time;
  decide_due_epochs(time);
  const bool has_new_answer =
      propagation_.has_anchor() && propagation_.time(time) > last_solution_time_;
  if (has_new_answer) source_ = source_at(time);
  publish_newest(time);
}

void InertialNavigator::on_restart(const Restart& restart) {
  if (restart.cause == ResetCause::kTimeBase) {
    start_over(data_time_);
  } else {
    clear_anchor();
    decisions_.invalidate_issued();
  }
  source_ = Source::kNone;
}

void InertialNavigator::clear_anchor() {
  propagation_.clear_anchor();
  pending_jump_m_ = 0.0;
  last_gnss_time_ = GpsTime();
}

void InertialNavigator::start_over(GpsTime now) {
  while (PendingEpoch* oldest = decisions_.oldest()) {
    decide(oldest, now, false);
    decisions_.pop();
  }
  clear_anchor();
  propagation_.clear_samples();
  imu_time_ = data_time_ = next_solution_due_ = last_solution_time_ = GpsTime();
}

// Drops the anchor after numbers have overflowed. Nothing is published until a restarted filter
// delivers the next one.
void InertialNavigator::drop_anchor(GpsTime now) {
  clear_anchor();
  propagation_.clear_samples();
  source_ = Source::kNone;
  events_.emit(EventKind::kFilterReset, static_cast<std::uint8_t>(ResetCause::kNotFinite), 0.0,
               now);
}

void InertialNavigator::decide_due_epochs(GpsTime now) {
  while (PendingEpoch* due = decisions_.next_filter_due(now)) decide_filter(due, now, true);
  while (PendingEpoch* oldest = decisions_.next_complete(now)) {
    if (oldest->issued.deadline_smoother.is_set()) decide_smoother(oldest, now, true);
    decisions_.pop();
  }
}

// Makes the remaining decisions. `usable` states whether a committed result may become the anchor.
void InertialNavigator::decide(PendingEpoch* epoch, GpsTime now, bool usable) {
  if (!epoch->filter_decided) decide_filter(epoch, now, usable);
  if (epoch->issued.deadline_smoother.is_set()) decide_smoother(epoch, now, usable);
}

void InertialNavigator::decide_filter(PendingEpoch* epoch, GpsTime now, bool usable) {
  Anchor anchor;
  if (!decisions_.take_filter(epoch, now, &anchor)) return;
  if (!usable || !anchor.valid || decisions_.is_invalid(*epoch)) return;
  // The smoother's anchor, also between its keyframes, uses the same GNSS.
  if (anchor.gnss_used && propagation_.has_anchor()) last_gnss_time_ = anchor.state.time;
  const bool smoother_gives_anchor =
      propagation_.has_anchor() && anchor_source_ == Source::kSmoother;
  if (epoch->issued.deadline_smoother.is_set() && smoother_gives_anchor)
    epoch->held = anchor;
  else
    commit(anchor, Source::kEkf, now);
}

void InertialNavigator::decide_smoother(PendingEpoch* epoch, GpsTime now, bool usable) {
  SmootherAnchor result;
  const bool taken = decisions_.take_smoother(epoch, now, &result);
  if (!usable || decisions_.is_invalid(*epoch)) return;
  if (taken && result.anchor.valid && commit(result.anchor, Source::kSmoother, now)) return;
  const bool not_due = taken && !result.due;  // the previous anchor remains
  if (epoch->held.valid && !not_due) commit(epoch->held, Source::kEkf, now);
}

// Continues from the new anchor. Returns false if that is impossible.
bool InertialNavigator::commit(const Anchor& anchor, Source source, GpsTime now) {
  if (anchor.state.time > now) return false;  // the IMU is behind or gone
  if (propagation_.has_discarded_after(anchor.state.time)) {
    events_.emit(EventKind::kCapacity, static_cast<std::uint8_t>(InertialCapacity::kHistory),
                 static_cast<double>(anchor.index), now);
    return false;
  }
  const bool had_anchor = propagation_.has_anchor();
  const GpsTime old_time = had_anchor ? propagation_.time(now) : GpsTime();
  const Eigen::Vector3d old_p_e =
      had_anchor ? propagation_.state(now).p_e : Eigen::Vector3d::Zero();
  const PvaCovariance old_covariance =
      had_anchor ? propagation_.covariance(old_time) : PvaCovariance::Zero();
  if (had_anchor && source != anchor_source_)
    events_.emit(EventKind::kSourceChange, static_cast<std::uint8_t>(source),
                 static_cast<double>(anchor.index), now);
  anchor_source_ = source;
  if (anchor.gnss_used) last_gnss_time_ = anchor.state.time;
  propagation_.restart_from(anchor, decisions_.earliest_needed(anchor.state.time));
  // Without samples there is no old answer at the time of the new one.
  if (had_anchor && propagation_.time(now) == old_time) report_jump(old_p_e, old_covariance, now);
  return true;
}

void InertialNavigator::report_jump(const Eigen::Vector3d& old_p_e,
                                    const PvaCovariance& old_covariance, GpsTime now) {
  const double jump_m = (propagation_.state(now).p_e - old_p_e).norm();
  pending_jump_m_ = std::max(pending_jump_m_, jump_m);
  const double sigma_m = std::sqrt(std::max(0.0, old_covariance.topLeftCorner<3, 3>().trace()));
  const bool is_surprise = jump_m > 3.0 * sigma_m;
  if (jump_m > kJumpEvent_m || is_surprise)
    events_.emit(EventKind::kSolutionJump, is_surprise ? 1 : 0, jump_m, now);
}

Source InertialNavigator::source_at(GpsTime now) const {
  if (!propagation_.has_anchor()) return Source::kNone;
  if (!propagation_.anchor().has_attitude) return Source::kAligning;
  const bool recent =
      last_gnss_time_.is_set() && nanoseconds_between(now, last_gnss_time_) <= ins_only_after_ns_;
  return recent ? anchor_source_ : Source::kInsOnly;
}

void InertialNavigator::publish_newest(GpsTime now) {
  if (!propagation_.has_anchor()) return;
  const GpsTime time = propagation_.time(now);
  if (time > last_solution_time_ && publication_due(time)) publish(time);
}

// Limits the mean rate to solution_rate_hz. Stamps that jitter by a quarter of a period lose no
// solution.
bool InertialNavigator::publication_due(GpsTime time) {
  if (solution_period_ns_ <= 0) return false;
  const GpsTime earliest = next_solution_due_.plus_nanoseconds(-solution_period_ns_ / 4);
  if (next_solution_due_.is_set() && time < earliest) return false;
  next_solution_due_ = next_solution_due_.plus_nanoseconds(solution_period_ns_);
  if (next_solution_due_ <= time) next_solution_due_ = time.plus_nanoseconds(solution_period_ns_);
  return true;
}

void InertialNavigator::publish(GpsTime time) {
  Solution solution;
  const PvaCovariance covariance = propagation_.covariance(time);
  fill_solution(propagation_.state(time), covariance, propagation_.anchor().has_attitude,
                &solution);
  if (!is_finite(solution)) return drop_anchor(time);
  set_levels(propagation_.anchor().levels.at(nominal_error(covariance, solution)), &solution);
  solution.sequence = next_solution_++;
  solution.source = source_;
  solution.anchor_epoch = propagation_.anchor().index;
  solution.jump_m = pending_jump_m_;
  pending_jump_m_ = 0.0;
  last_solution_time_ = time;
  sink_->on_solution(solution);
}

}  // namespace leonav
