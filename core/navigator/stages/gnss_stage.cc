#include "core/navigator/stages/gnss_stage.h"

#include <optional>
#include <variant>

#include "core/filter/state/covariance_blocks.h"
#include "core/navigator/interface/solution_conversion.h"
#include "core/navigator/stages/internal/anchor_from_filter.h"
#include "core/navigator/stages/internal/attitude_carry_over.h"
#include "core/navigator/stages/internal/checkpoint_from_filter.h"

namespace leonav {
namespace {

EkfConfig filter_config(EkfConfig config, bool keep_process) {
  config.keep_process = keep_process;
  return config;
}

Posture posture_of(VehicleKind kind) {
  if (kind == VehicleKind::kHandheld) return Posture::kInHand;
  return kind == VehicleKind::kUav ? Posture::kInFlight : Posture::kUpright;
}

OutageMonitor::Position antenna_position(const Ekf& filter) {
  return {filter.antenna_position_e(), filter.antenna_position_covariance_e()};
}

}  // namespace

GnssStage::GnssStage(const NavigatorConfig& config, TimedMailbox<Anchor>* ekf_mailbox,
                     KeyframeSink* keyframes, OutputSink* sink)
    : config_(config),
      mailbox_(ekf_mailbox),
      keyframes_(keyframes),
      inertial_(config.motion == MotionModel::kInertial),
      front_end_(config),
      ekf_(filter_config(config.ekf, keyframes != nullptr), config.imu, config.vehicle.lever_arm_b),
      motion_aiding_(config.vehicle.motion, config.imu.accel_bias, config.ekf.use_carrier),
      filter_monitor_(config),
      code_combination_(config.gnss.code_combination),
      attitude_(config),
      calibration_(config),
      reporter_(sink),
      pending_keyframe_(config.smoother.keyframe_interval_s),
      installation_monitor_(config.gnss, config.ekf.robust, config.vehicle.lever_arm_b,
                            config.alignment.max_reverse_speed_m_s,
                            posture_of(config.vehicle.kind)) {}

void GnssStage::process(const GnssWork& work) {
  std::visit([this](const auto& of_kind) { process_work(of_kind); }, work);
}

void GnssStage::process_work(const EpochWork& work) {
  reporter_.start(work);
  epoch_ = EpochState();
  use_heading(work);
  follow_window(work);
  predict(work);
  apply(filter_monitor_.test_finite(ekf_), work.time);
  const auto gap_s = imu_gaps_.add(work);
  if (gap_s) pending_keyframe_.end_window();  // also of a window that alone has an attitude
  if (gap_s && ekf_.has_attitude()) reset(kAttitudeReset, work.time, ResetCause::kImuGap, *gap_s);
  if (!work.empty) use_measurements(work);
  apply(filter_monitor_.test_finite(ekf_), work.time);
  monitor_heading(work);
  if (epoch_.gnss_used) {
    last_gnss_time_ = work.time;
    initialize_attitude(work);
  }
  attitude_.monitor_motion(work, ekf_);
  check_installation(work);
  report_solution(work);
  if (inertial_)
    mailbox_->deliver(work.index, anchor_from_filter(work.index, ekf_, epoch_.gnss_used, levels_));
  reporter_.report_orbit_changes();
  publish(work);
  push_keyframe(work);
}

// A filter that has started over takes the state of the smoother's window, once it is decided that
// this is in time, for it knows more. What the filter does thereby depends on data time alone. What
// has come from outside since the keyframe counts more: a process that is not continuous any more,
// or a heading that ends the window.
void GnssStage::follow_window(const EpochWork& work) {
  if (keyframes_ == nullptr || !inertial_ || !work.smoother_decided || !ekf_.initialized()) return;
  if (!ekf_.estimate().process().continuous || pending_keyframe_.ends_window() || pending_heading_)
    return;
  SmootherAnchor result;
  if (!keyframes_->result_of(work.index - 1, &result) || !result.filter_may_follow) return;
  const Anchor& window = result.anchor;
  if (!window.valid || window.state.time != ekf_.state().time) return;
  const double moved_m = (window.state.p_e - ekf_.state().p_e).norm();
  ekf_.replace_motion(window.state, window.covariance, window.random_walk);
  reset(kWindowReset, last_epoch_time_, ResetCause::kWindow, moved_m);
  attitude_.start_heading_monitor(ekf_);
  reporter_.report_checkpoint(attitude_.discard_checkpoint(), last_epoch_time_);
}

void GnssStage::predict(const EpochWork& work) {
  attitude_.add(work.block, ekf_);
  motion_aiding_.predict({work.block.data(), work.block.size()},
                         {work.odometer.data(), work.odometer.size()}, work.time, &ekf_);
  motion_aiding_.set_carrier_speed(std::nullopt);  // it holds for one prediction only
  const auto contradiction = motion_aiding_.contradiction();
  reporter_.add_prediction(last_epoch_time_, motion_aiding_, contradiction);
  last_epoch_time_ = work.time;
}

void GnssStage::use_measurements(const EpochWork& work) {
  RefusedOrbits begun;
  const int refused = front_end_.compare_orbits(work.raw, &begun);
  reporter_.report_refused_orbits(refused, {begun.data(), begun.size()}, work.time);
  front_end_.exclude(satellite_faults_.excluded(work.time));
  front_end_.combine_codes(code_combination_.combination());
  if (!ekf_.initialized())
    start_filter(work);
  else if (filter_monitor_.prediction_is_too_uncertain(ekf_, work.time, last_gnss_time_))
    restart_after_outage(work);
  else
    update_filter(work);
  reporter_.monitor_usability();
}

void GnssStage::start_filter(const EpochWork& work) {
  const IndependentSolution solution = front_end_.solve(work, Eigen::Vector3d::Zero());
  if (solution.accepted) {
    // An epoch whose time may be wrong does not judge the calibration's age.
    report_calibration(calibration_.start(work.time, &ekf_), work.time);
    ekf_.initialize(work.time, solution.point);
    epoch_.gnss_used = true;
  }
  reporter_.add_point(solution);
}

void GnssStage::restart_after_outage(const EpochWork& work) {
  const IndependentSolution solution = front_end_.solve(work, Eigen::Vector3d::Zero());
  if (solution.accepted) {
    const OutageMonitor::Position before = antenna_position(ekf_);
    apply(filter_monitor_.restart_after_outage(solution.point, ekf_, work.time), work.time);
    reporter_.report_outage(before, antenna_position(ekf_), work.time);
  }
  reporter_.add_point(solution);
}

void GnssStage::update_filter(const EpochWork& work) {
  front_end_.measure(work, ekf_);
  if (motion_aiding_.requires_carrier_speed())
    motion_aiding_.set_carrier_speed(front_end_.update_carrier_speed());
  const OutageMonitor::Position before = antenna_position(ekf_);
  const EkfUpdateResult update = ekf_.update(front_end_.measurements());
  epoch_.filter_updated = true;
  front_end_.store_update(update, ekf_);
  epoch_.gnss_used = update.used > 0;
  if (epoch_.gnss_used) reporter_.report_outage(before, antenna_position(ekf_), work.time);
  reporter_.add_update(front_end_.measurements(), update, ekf_);
  reporter_.report_consistency(filter_monitor_.add_consistency(update), work.time);
  reporter_.report_clock_steps(update, work.time);
  reporter_.report_contradictions(update, work.time);
  code_combination_.add(front_end_.measurements(), ekf_.learned_errors(),
                        ekf_.carriers_keep_position());
  test_satellites(work, update);
  test_update(work, update);
}

// A convicted satellite is not used from the next epoch on; what the filter has followed of its
// error becomes part of the covariance at once.
void GnssStage::test_satellites(const EpochWork& work, const EkfUpdateResult& update) {
  const FilterEvidence evidence = {work.time, update, front_end_.measurements(), ekf_};
  const auto fault = satellite_faults_.add(carrier_innovations(evidence), work.time);
  const PositionEstimate estimate = {ekf_.state().p_e, position_covariance_e(ekf_.covariance())};
  fault_hypotheses_ = satellite_fault_hypotheses(
      satellite_faults_, front_end_.measurements(), ekf_.measurements(),
      ekf_.filter_state().ambiguities, estimate, config_.integrity, config_.gnss.bands);
  if (!fault) return;
  ekf_.allow_for_fault(fault->satellite, fault->followed_m, front_end_.measurements());
  reporter_.emit(EventKind::kSatelliteFault, static_cast<std::uint8_t>(fault->satellite.system),
                 fault->satellite.number, work.time);
}

// Runs the tests in turn, until one has restarted the filter: `update` belongs to the filter before
// the restart.
void GnssStage::test_update(const EpochWork& work, const EkfUpdateResult& update) {
  const FilterEvidence evidence = {work.time, update, front_end_.measurements(), ekf_};
  EpochSolver solver(&front_end_, work);
  apply(filter_monitor_.test_prediction(evidence, &solver), work.time);
  if (epoch_.filter_restarted) return;
  apply(filter_monitor_.test_rejections(evidence), work.time);
  if (epoch_.filter_restarted) return;
  apply(filter_monitor_.test_position(evidence, &solver), work.time);
}

void GnssStage::monitor_heading(const EpochWork& work) {
  if (!attitude_.monitor_heading(work, ekf_, epoch_.filter_updated)) return;
  const IndependentSolution solution =
      front_end_.solve_without_biases(work, ekf_.antenna_position_e());
  if (const auto error = attitude_.heading_error(solution, ekf_))
    reset(kHeadingReset, work.time, ResetCause::kHeading, *error, solution.point);
}

void GnssStage::initialize_attitude(const EpochWork& work) {
  if (!attitude_.is_due(work, ekf_)) return;
  reporter_.report_checkpoint(attitude_.evaluate_checkpoint(work.time, ekf_), work.time);
  const auto first = attitude_.first_attitude(ekf_);
  if (!first) return;
  const AlignedAttitude& aligned = first->aligned;
  report_calibration(calibration_.set_attitude(aligned, work.time, &ekf_), work.time);
  if (!first->heading_given)
    ekf_.raise_attitude_noise(config_.alignment.settling_random_walk, config_.alignment.settling_s);
  attitude_.start_heading_monitor(ekf_);
  reporter_.emit(EventKind::kAligned, aligned.gyro_bias_known ? 1 : 0, aligned.sigma_rpy.z(),
                 work.time);
  reporter_.report_checkpoint(attitude_.discard_checkpoint(), work.time);
}

// Tests the inputs themselves, independently of the filter, and only reports.
void GnssStage::check_installation(const EpochWork& work) {
  for (const ImuSample& sample : work.block) installation_monitor_.add(sample);
  if (work.empty || !installation_monitor_.is_due(work.time)) return;
  const bool attitude = ekf_.has_attitude() && ekf_.state().time == work.time;
  const auto finding = installation_monitor_.end_second(work.raw, front_end_.ephemeris_store(),
                                                        attitude ? &ekf_.state().q_eb : nullptr);
  if (finding)
    reporter_.emit(EventKind::kConventionSuspect, static_cast<std::uint8_t>(finding.convention),
                   finding.value, work.time);
}

// Tests the solution as a whole once more, because a finite state can be so wrong that its geodetic
// coordinates are not finite.
void GnssStage::report_solution(const EpochWork& work) {
  reporter_.add_state(ekf_);
  if (!is_finite(reporter_.report().solution)) {
    reset(kDropReset, work.time, ResetCause::kNotFinite, 0.0);
    reporter_.clear_solution();
  }
  levels_ = reporter_.add_levels(ekf_, fault_hypotheses_, config_.integrity);
  motion_aiding_.set_satellites_used(reporter_.report().satellites_used);
}

void GnssStage::publish(const EpochWork& work) {
  const Solution& solution = reporter_.report().solution;
  std::optional<Checkpoint> checkpoint;
  if (inertial_ && ekf_.initialized())
    checkpoint = checkpoint_from_filter(work, ekf_, solution, config_);
  const bool publishes_solution = !inertial_ && keyframes_ == nullptr && ekf_.initialized();
  reporter_.publish(source(), attitude_.need(ekf_, solution.latitude), checkpoint,
                    publishes_solution);
}

// Pushes the keyframe last, because the smoother may start with it at once.
void GnssStage::push_keyframe(const EpochWork& work) {
  if (keyframes_ == nullptr) return motion_aiding_.clear_instants();
  pending_keyframe_.add(work.block);
  const bool due = pending_keyframe_.is_due(ekf_, work.time);
  KeyframeInput* keyframe = due ? keyframes_->next_keyframe(work.index) : nullptr;
  if (keyframe == nullptr) {
    if (due) reporter_.report_skipped_keyframe(work);
    return keyframes_->no_keyframe(reporter_.report().solution, due);
  }
  pending_keyframe_.make(work, epoch_.filter_updated ? &front_end_.measurements() : nullptr,
                         &motion_aiding_, &ekf_, keyframe);
  keyframe->has_gnss = source() != Source::kInsOnly;
  keyframe->fault_hypotheses = reporter_.report().fault_hypotheses;
  keyframes_->push_keyframe();
}

void GnssStage::process_work(const Command& command) {
  CommandResult result = CommandResult::kDone;
  const GpsTime time = last_epoch_time_;  // which a restart forgets
  if (command.kind == CommandKind::kRestart)
    reset(kCommandReset, last_epoch_time_, command.cause, 0.0);
  else if (attitude_.contradicts_motion(command.value, command.sigma, ekf_))
    result = CommandResult::kContradictsMotion;
  else
    take_heading(command);
  if (command.sequence)
    reporter_.emit(EventKind::kCommand, static_cast<std::uint8_t>(result),
                   static_cast<double>(*command.sequence), time);
}

// A heading that holds later than the filter's state waits for the samples between the two.
void GnssStage::take_heading(const Command& command) {
  pending_heading_.reset();
  if (ekf_.has_attitude() && ekf_.state().time < command.time)
    pending_heading_ = command;
  else
    set_heading(command.value, command.sigma);
}

void GnssStage::use_heading(const EpochWork& work) {
  if (!pending_heading_ || work.time < pending_heading_->time) return;
  const Command command = *pending_heading_;
  pending_heading_.reset();
  const double turned =
      ekf_.has_attitude() ? heading_change(ekf_.state(), work.block, command.time) : 0.0;
  set_heading(command.value - turned, command.sigma);
}

// Replaces only the attitude; position, velocity, clocks and IMU errors do not change.
void GnssStage::set_heading(double heading, double sigma) {
  const auto turned = attitude_.set_heading(heading, sigma, ekf_);
  // The window may have an attitude where the filter has none.
  if (!turned) return pending_keyframe_.end_window();
  ekf_.replace_attitude(turned->q_eb, turned->sigma_rpy);
  attitude_.start_heading_monitor(ekf_);
  reporter_.emit(EventKind::kAligned, 1, sigma, ekf_.state().time);
}

void GnssStage::process_work(const Checkpoint& checkpoint) {
  if (!inertial_) return;
  if (!ekf_.initialized()) calibration_.take(checkpoint);
  attitude_.take_checkpoint(checkpoint);
  if (ekf_.has_attitude())
    reporter_.report_checkpoint(attitude_.discard_checkpoint(), last_epoch_time_);
}

void GnssStage::report_calibration(const std::optional<SavedCalibration::Verdict>& verdict,
                                   GpsTime time) {
  if (verdict)
    reporter_.emit(EventKind::kCheckpoint, static_cast<std::uint8_t>(verdict->use), verdict->value,
                   time);
}

void GnssStage::apply(const FilterVerdict& verdict, GpsTime time) {
  switch (verdict.action) {
    case FilterAction::kKeep:
      return;
    case FilterAction::kRestartClocks:
      return ekf_.restart_clock_offsets();
    case FilterAction::kDrop:
      return reset(kDropReset, time, verdict.cause, verdict.value);
    case FilterAction::kRestart:
      return reset(restart_reset(verdict.keeps_attitude, verdict.keeps_vehicle_constants), time,
                   verdict.cause, verdict.value, verdict.start);
  }
}

void GnssStage::reset(const ResetPlan& plan, GpsTime time, ResetCause cause, double value,
                      const PointSolution& start) {
  const bool attitude_lost = ekf_.has_attitude() && !plan.keeps_attitude;
  if (plan.clears_external_heading) attitude_.forget_heading();
  if (plan.clears_times) pending_heading_.reset();
  if (plan.filter == FilterReset::kReset) ekf_.reset();
  if (plan.filter == FilterReset::kRestart) restart_filter(plan, time, start);
  if (plan.filter == FilterReset::kForgetAttitude) ekf_.forget_attitude();
  if (plan.carriers == CarrierReset::kAll) front_end_.reset_carriers();
  if (plan.carriers == CarrierReset::kPosition) front_end_.reset_position();
  if (plan.clears_alignment) attitude_.reset_alignment();
  if (plan.clears_motion_aiding) motion_aiding_.reset();
  if (plan.clears_outage_monitor) reporter_.reset_outage();
  if (plan.clears_installation_monitor) installation_monitor_.clear();
  // An attitude that a user or an overflow ends was not found wrong. Where the filter had none, the
  // window's is its own.
  const bool found_wrong =
      attitude_lost && cause != ResetCause::kCommand && cause != ResetCause::kNotFinite;
  if (found_wrong || cause == ResetCause::kTimeBase) pending_keyframe_.end_window();
  if (plan.clears_times)
    filter_monitor_.time_begins_anew();
  else if (plan.filter == FilterReset::kForgetAttitude)
    filter_monitor_.clear_evidence();  // the filter goes on, and nothing of it was found wrong
  else
    filter_monitor_.filter_restarted(time);
  satellite_faults_.filter_restarted(plan.clears_times);
  fault_hypotheses_.clear();
  if (plan.clears_times) last_gnss_time_ = GpsTime();
  epoch_.gnss_used = plan.counts_as_gnss_epoch;
  epoch_.filter_restarted = true;
  reporter_.emit(EventKind::kFilterReset, static_cast<std::uint8_t>(cause), value, time);
}

void GnssStage::restart_filter(const ResetPlan& plan, GpsTime time, const PointSolution& start) {
  // Clocks that the restarted filter does not estimate stay in the epoch's report as they were.
  reporter_.add_state(ekf_);
  std::optional<AttitudeCarryOver> attitude;
  if (plan.keeps_attitude) attitude.emplace(ekf_, config_.alignment.levelling_sigma);
  if (!plan.keeps_vehicle_constants) ekf_.reset_vehicle_constants();
  ekf_.initialize(time, start);
  if (attitude) attitude->give_to(&ekf_, time);
}

Source GnssStage::source() const {
  if (!ekf_.initialized()) return Source::kNone;
  if (inertial_ && !ekf_.has_attitude()) return Source::kAligning;
  const double since_s = seconds_between(last_epoch_time_, last_gnss_time_);
  const bool recent = since_s <= config_.realtime.ins_only_after_s();
  return recent ? Source::kEkf : Source::kInsOnly;
}

}  // namespace leonav
