#include "core/navigator/inertial_navigator.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include "core/earth/gravity.h"
#include "core/navigator/covariance_growth.h"

namespace leonav {
namespace {

// Half of the mailbox: the slots of epochs already decided are free long before they come round.
constexpr std::size_t kMaxWaiting = kMaxMailboxEpochs / 2;
constexpr double kLongestHole_s = 10.0;    // beyond, the old answer is worth nothing
constexpr double kHoleAcceleration = 3.0;  // (m/s^2)/sqrt(Hz), of a vehicle nobody watches
constexpr double kHoleRotation = 0.5;      // rad/sqrt(s), likewise
constexpr double kJumpEvent_m = 1.0;

std::int64_t to_nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::llround(seconds * 1e9));
}

}  // namespace

InertialNavigator::InertialNavigator(const NavigatorConfig& config,
                                     TimedMailbox<EkfUpdate>* ekf_mailbox,
                                     TimedMailbox<SmootherUpdate>* smoother_mailbox,
                                     OutputSink* sink)
    : config_(config),
      mailbox_(ekf_mailbox),
      smoother_mailbox_(smoother_mailbox),
      sink_(sink),
      events_(Stage::kInertial, sink),
      solution_period_ns_(
          config.solution_rate_hz > 0.0 ? to_nanoseconds(1.0 / config.solution_rate_hz) : 0),
      ins_only_after_ns_(to_nanoseconds(2.5 * config.realtime.epoch_interval_s +
                                        config.realtime.gnss_latency_allowance_s +
                                        config.realtime.deadline_ekf_s)),
      history_(kMaxImuHistory),
      waiting_(kMaxWaiting) {}

void InertialNavigator::process(const InertialWork& work) {
  if (const auto* sample = std::get_if<ImuSample>(&work)) {
    on_sample(*sample);
  } else if (const auto* epoch = std::get_if<EpochIssued>(&work)) {
    on_epoch(*epoch);
  } else if (const auto* restart = std::get_if<Restart>(&work)) {
    on_restart(*restart);
  }
}

void InertialNavigator::on_epoch(const EpochIssued& epoch) {
  if (waiting_.full()) {  // the IMU has stopped, so no deadline is ever reached
    Waiting oldest = waiting_.front();
    waiting_.pop_front();
    events_.emit(EventKind::kCapacity, static_cast<std::uint8_t>(InertialCapacity::kWaiting),
                 static_cast<double>(oldest.issued.index), imu_time_);
    decide(&oldest, imu_time_, true);
  }
  waiting_.push_back({epoch, false, {}});
}

void InertialNavigator::on_sample(const ImuSample& sample) {
  const bool first = !imu_time_.is_set();
  if (!first &&
      (sample.time <= imu_time_ || seconds_between(sample.start(), imu_time_) > kLongestHole_s)) {
    start_over(sample.time);
  }
  imu_time_ = sample.time;
  history_.push_back(sample);  // when full, the oldest goes
  if (anchor_.valid) step(sample);
  decide_due_epochs(sample.time);
  source_ = source_at(sample.time);
  if (publication_due(sample)) publish(sample.time);
}

void InertialNavigator::on_restart(const Restart& restart) {
  if (restart.cause == ResetCause::kTimeBase) {
    start_over(imu_time_);
  } else {
    forget_anchor();
    if (!waiting_.empty()) last_void_epoch_ = waiting_.back().issued.index;
  }
  source_ = Source::kNone;
}

void InertialNavigator::forget_anchor() {
  anchor_ = EkfUpdate();
  bridged_s_ = pending_jump_m_ = 0.0;
  bridge_angle_variance_ = bridge_velocity_variance_ = 0.0;
  last_gnss_time_ = GpsTime();
}

void InertialNavigator::forget_samples() {
  history_.clear();
  last_sample_ = ImuSample();
}

void InertialNavigator::start_over(GpsTime now) {
  while (!waiting_.empty()) {
    decide(&waiting_.front(), now, false);
    waiting_.pop_front();
  }
  forget_anchor();
  forget_samples();
  next_solution_due_ = GpsTime();
}

// Numbers have overflowed: no answer until a filter that is sound delivers the next anchor.
void InertialNavigator::drop_anchor(GpsTime now) {
  forget_anchor();
  forget_samples();
  source_ = Source::kNone;
  events_.emit(EventKind::kFilterReset, static_cast<std::uint8_t>(ResetCause::kNotFinite), 0.0,
               now);
}

void InertialNavigator::decide_due_epochs(GpsTime now) {
  for (Waiting& waiting : waiting_)
    if (!waiting.ekf_decided && waiting.issued.deadline_ekf <= now) decide_ekf(&waiting, now, true);
  while (!waiting_.empty() && waiting_.front().ekf_decided) {
    Waiting& oldest = waiting_.front();
    const GpsTime deadline = oldest.issued.deadline_smoother;
    if (deadline.is_set() && deadline > now) return;
    if (deadline.is_set()) decide_smoother(&oldest, now, true);
    waiting_.pop_front();
  }
}

// All that is left to decide.
void InertialNavigator::decide(Waiting* waiting, GpsTime now, bool usable) {
  if (!waiting->ekf_decided) decide_ekf(waiting, now, usable);
  if (waiting->issued.deadline_smoother.is_set()) decide_smoother(waiting, now, usable);
}

template <typename Update>
bool InertialNavigator::take(TimedMailbox<Update>* mailbox, std::uint8_t number,
                             const EpochIssued& epoch, GpsTime now, Update* update) {
  Decision decision;
  decision.sequence = next_decision_++;
  decision.epoch = epoch.index;
  decision.time = now;
  decision.mailbox = number;
  decision.committed = mailbox->take(epoch.index, update);
  if constexpr (std::is_same_v<Update, SmootherUpdate>) decision.iterations = update->iterations;
  sink_->on_decision(decision);
  if (!decision.committed)
    events_.emit(EventKind::kDeadlineMiss, number, static_cast<double>(epoch.index), now);
  return decision.committed;
}

void InertialNavigator::decide_ekf(Waiting* waiting, GpsTime now, bool usable) {
  const EpochIssued& epoch = waiting->issued;
  waiting->ekf_decided = true;
  EkfUpdate update;
  if (!take(mailbox_, 0, epoch, now, &update)) {
    ++misses_;
    return;
  }
  if (!usable || !update.valid || epoch.index <= last_void_epoch_) return;
  // The smoother's answer, also between its keyframes, rests on the same GNSS.
  if (update.gnss_used && anchor_.valid) last_gnss_time_ = update.state.time;
  const bool smoother_answers = anchor_.valid && anchor_source_ == Source::kSmoother;
  if (epoch.deadline_smoother.is_set() && smoother_answers)
    waiting->held = update;
  else
    commit(update, Source::kEkf, now);
}

void InertialNavigator::decide_smoother(Waiting* waiting, GpsTime now, bool usable) {
  const EpochIssued& epoch = waiting->issued;
  SmootherUpdate update;
  const bool taken = take(smoother_mailbox_, 1, epoch, now, &update);
  if (!taken) ++smoother_misses_;
  if (!usable || epoch.index <= last_void_epoch_) return;
  if (taken && update.anchor.valid && commit(update.anchor, Source::kSmoother, now)) return;
  const bool not_due = taken && !update.due;  // the one before stays the anchor
  if (waiting->held.valid && !not_due) commit(waiting->held, Source::kEkf, now);
}

// Goes on from the new anchor: the samples since then once more. False: it cannot.
bool InertialNavigator::commit(const EkfUpdate& update, Source source, GpsTime now) {
  if (update.state.time > now) return false;  // the IMU is behind or gone
  const bool too_old = history_.empty() || history_.front().start() > update.state.time;
  if (too_old && history_.full()) {
    events_.emit(EventKind::kCapacity, static_cast<std::uint8_t>(InertialCapacity::kHistory),
                 static_cast<double>(update.index), now);
    return false;
  }
  const bool had_answer = anchor_.valid;
  const Eigen::Vector3d old_p_e = had_answer ? current(now).p_e : Eigen::Vector3d::Zero();
  const PvaCovariance old_covariance = had_answer ? covariance_at(now) : PvaCovariance::Zero();

  if (had_answer && source != anchor_source_)
    events_.emit(EventKind::kSourceChange, static_cast<std::uint8_t>(source),
                 static_cast<double>(update.index), now);
  anchor_ = update;
  anchor_source_ = source;
  if (update.gnss_used) last_gnss_time_ = update.state.time;
  bridged_s_ = bridge_angle_variance_ = bridge_velocity_variance_ = 0.0;
  forget_before(update.state.time);
  mechanization_.reset(update.state);
  for (const ImuSample& sample : history_) step(sample);
  if (had_answer) report_jump(old_p_e, old_covariance, now);
  return true;
}

// What an epoch that is still to be decided might go on from is kept.
void InertialNavigator::forget_before(GpsTime time) {
  for (const Waiting& waiting : waiting_) time = std::min(time, waiting.issued.time);
  while (!history_.empty() && history_.front().time <= time) {
    last_sample_ = history_.front();
    history_.pop_front();
  }
  if (!history_.empty() && history_.front().start() < time) {
    const ImuSplit parts = split(history_.front(), time);
    last_sample_ = parts.before;
    history_.front() = parts.after;
  }
}

void InertialNavigator::step(const ImuSample& sample) {
  if (!anchor_.has_attitude) return;
  if (sample.time <= mechanization_.state().time) {
    last_sample_ = sample;
    return;
  }
  const GpsTime from = mechanization_.state().time;
  if (sample.start() > from) bridge(sample);
  mechanization_.advance(sample.start() < from ? split(sample, from).after : sample);
  last_sample_ = sample;
}

// Moves the mechanization to the start of `next` over a hole in the stream.
void InertialNavigator::bridge(const ImuSample& next) {
  const GpsTime from = mechanization_.state().time;
  const double hole_s = seconds_between(next.start(), from);
  if (const auto bridge = bridge_hole(last_sample_, from, next.start(), next)) {
    mechanization_.advance(bridge->filler);
    bridge_angle_variance_ += bridge->sigma_theta_b.cwiseAbs2().maxCoeff();
    bridge_velocity_variance_ += bridge->sigma_velocity_b.cwiseAbs2().maxCoeff();
    return;
  }
  NavState state = mechanization_.state();
  state.p_e += hole_s * state.v_e;
  state.time = next.start();
  mechanization_.reset(state);
  bridged_s_ += hole_s;
}

void InertialNavigator::report_jump(const Eigen::Vector3d& old_p_e,
                                    const PvaCovariance& old_covariance, GpsTime now) {
  const double jump_m = (current(now).p_e - old_p_e).norm();
  pending_jump_m_ = std::max(pending_jump_m_, jump_m);
  const double sigma_m = std::sqrt(std::max(0.0, old_covariance.topLeftCorner<3, 3>().trace()));
  if (jump_m > kJumpEvent_m || jump_m > 3.0 * sigma_m) {
    events_.emit(EventKind::kSolutionJump, 0, jump_m, now);
  }
}

NavState InertialNavigator::current(GpsTime now) const {
  if (anchor_.has_attitude) return at_stamp(mechanization_.state(), anchor_.time_offset_s);
  NavState state = anchor_.state;
  state.p_e += seconds_between(now, anchor_.state.time) * state.v_e;
  state.time = now;
  return state;
}

PvaCovariance InertialNavigator::covariance_at(GpsTime now) const {
  const double elapsed_s = seconds_between(now, anchor_.state.time);
  if (!anchor_.has_attitude) {
    return constant_velocity_covariance(anchor_, config_.ekf.acceleration_noise_horizontal,
                                        elapsed_s);
  }
  const NavState& state = mechanization_.state();
  // Mean specific force since the anchor: what changed the velocity, less gravity.
  Eigen::Vector3d f_e = -gravity_e(state.p_e);
  if (elapsed_s > 0.0) f_e += (state.v_e - anchor_.state.v_e) / elapsed_s;
  PvaCovariance covariance =
      inertial_covariance(anchor_, config_.imu, f_e, state.q_eb.toRotationMatrix(), elapsed_s);
  covariance.diagonal().head<3>().array() += bridge_velocity_variance_ * elapsed_s * elapsed_s;
  covariance.diagonal().segment<3>(3).array() += bridge_velocity_variance_;
  covariance.diagonal().tail<3>().array() += bridge_angle_variance_;
  if (bridged_s_ > 0.0) {
    add_acceleration_noise(kHoleAcceleration, bridged_s_, &covariance);
    covariance.diagonal().tail<3>().array() += kHoleRotation * kHoleRotation * bridged_s_;
  }
  return covariance;
}

Source InertialNavigator::source_at(GpsTime now) const {
  if (!anchor_.valid) return Source::kNone;
  if (!anchor_.has_attitude) return Source::kAligning;
  const bool recent = last_gnss_time_.is_set() &&
                      now.nanoseconds() - last_gnss_time_.nanoseconds() <= ins_only_after_ns_;
  return recent ? anchor_source_ : Source::kInsOnly;
}

// At most solution_rate_hz on average; a quarter of a period of jitter in the stamps costs nothing.
bool InertialNavigator::publication_due(const ImuSample& sample) {
  if (!anchor_.valid || solution_period_ns_ <= 0) return false;
  const GpsTime earliest = next_solution_due_.plus_nanoseconds(-solution_period_ns_ / 4);
  if (next_solution_due_.is_set() && sample.time < earliest) return false;
  next_solution_due_ = next_solution_due_.plus_nanoseconds(solution_period_ns_);
  if (next_solution_due_ <= sample.time) {
    next_solution_due_ = sample.time.plus_nanoseconds(solution_period_ns_);
  }
  return true;
}

void InertialNavigator::publish(GpsTime now) {
  Solution solution;
  fill_solution(current(now), covariance_at(now), anchor_.has_attitude, &solution);
  if (!is_finite(solution)) return drop_anchor(now);
  solution.sequence = next_solution_++;
  solution.source = source_;
  solution.anchor_epoch = anchor_.index;
  solution.jump_m = pending_jump_m_;
  pending_jump_m_ = 0.0;
  sink_->on_solution(solution);
}

}  // namespace leonav
