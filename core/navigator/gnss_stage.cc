#include "core/navigator/gnss_stage.h"

#include <utility>
#include <variant>

#include "core/gnss/point_solution.h"
#include "core/gnss/preprocess.h"
#include "core/navigator/epoch_report.h"
#include "core/navigator/solution.h"

namespace leonav {
namespace {

constexpr int kMinSatellites = 4;
constexpr double kMaxPdop = 15.0;
constexpr double kVagueSigma_m = 20.0;  // a prediction that corrects delays to a centimetre
constexpr double kMaxResidualRms_m = 60.0;

// A start has nothing to compare its measurements with but each other: it always excludes faults,
// also where the filter is told to trust everything.
RobustConfig robust_start(RobustConfig config) {
  config.enabled = true;
  return config;
}

EkfConfig filter_config(EkfConfig config, bool keep_process) {
  config.keep_process = keep_process;
  return config;
}

EventKind event_of(OrbitChange change) {
  switch (change) {
    case OrbitChange::kNone:
    case OrbitChange::kFallback:
      break;
    case OrbitChange::kReturn:
      return EventKind::kOrbitReturn;
    case OrbitChange::kClockFallback:
      return EventKind::kClockFallback;
    case OrbitChange::kClockReturn:
      return EventKind::kClockReturn;
  }
  return EventKind::kOrbitFallback;
}

Posture posture_of(VehicleKind kind) {
  if (kind == VehicleKind::kHandheld) return Posture::kInHand;
  return kind == VehicleKind::kUav ? Posture::kInFlight : Posture::kUpright;
}

// As the event has them: side 1, vertical 2, standing's velocity 4 and rate 8, odometer 16.
std::uint8_t constraint_groups(MotionComponents components) {
  const auto bits = [&](MotionComponent first, unsigned count) {
    return (components >> static_cast<unsigned>(first)) & ((1u << count) - 1u);
  };
  return static_cast<std::uint8_t>((bits(MotionComponent::kSide, 1) != 0 ? 1 : 0) |
                                   (bits(MotionComponent::kVertical, 1) != 0 ? 2 : 0) |
                                   (bits(MotionComponent::kVelocity, 3) != 0 ? 4 : 0) |
                                   (bits(MotionComponent::kAngularRate, 3) != 0 ? 8 : 0) |
                                   (bits(MotionComponent::kOdometer, 1) != 0 ? 16 : 0));
}

}  // namespace

GnssStage::GnssStage(const NavigatorConfig& config, TimedMailbox<EkfUpdate>* ekf_mailbox,
                     KeyframeSink* keyframes, OutputSink* sink)
    : config_(config),
      mailbox_(ekf_mailbox),
      keyframes_(keyframes),
      sink_(sink),
      events_(Stage::kGnss, sink),
      inertial_(config.motion == MotionModel::kInertial),
      catalog_(config.gnss.catalog),
      carriers_(config.gnss.cycle_slips),
      ekf_(filter_config(config.ekf, keyframes != nullptr), config.imu, config.vehicle.lever_arm_b),
      motion_aid_(config.vehicle.motion, config.imu.accel_bias, config.ekf.use_carrier),
      alignment_(config.alignment, config.imu),
      heading_watch_(config.alignment, config.imu),
      checkpoint_judge_(config.alignment, config.imu.gyro_bias.sigma, config.checkpoint_max_age_s),
      measurements_(std::make_unique<MeasurementEpoch>()),
      check_measurements_(std::make_unique<MeasurementEpoch>()),
      report_(std::make_unique<EpochReport>()),
      keyframe_maker_(config.smoother.keyframe_interval_s),
      convention_check_(config.gnss, config.ekf.robust, config.vehicle.lever_arm_b,
                        config.alignment.max_reverse_speed_m_s, posture_of(config.vehicle.kind)) {
  const AlignmentConfig& alignment = config_.alignment;
  if (alignment.initial_heading)
    given_heading_.tell({*alignment.initial_heading, alignment.initial_heading_sigma});
}

void GnssStage::process(const GnssWork& work) {
  if (const auto* epoch = std::get_if<EpochWork>(&work)) {
    process_epoch(*epoch);
  } else if (const auto* ephemeris = std::get_if<Ephemeris>(&work)) {
    catalog_.add(*ephemeris);
  } else if (const auto* states = std::get_if<PreciseStates>(&work)) {
    for (const PreciseState& state : *states) catalog_.add(state);
  } else if (const auto* klobuchar = std::get_if<KlobucharModel>(&work)) {
    catalog_.set_klobuchar(*klobuchar);
  } else if (const auto* antenna = std::get_if<AntennaPattern>(&work)) {
    antennas_.add(*antenna);
  } else if (const auto* command = std::get_if<Command>(&work)) {
    process_command(*command);
  } else if (const auto* checkpoint = std::get_if<Checkpoint>(&work)) {
    take_checkpoint(*checkpoint);
  }
}

void GnssStage::process_epoch(const EpochWork& work) {
  start_report(work.index, work.time, work.empty, report_.get());
  const GpsTime before = last_epoch_time_;
  last_epoch_time_ = work.time;
  gnss_used_ = updated_ = false;
  if (inertial_ && !ekf_.has_attitude()) {
    for (const ImuSample& sample : work.block) {
      alignment_.add(sample);
      checkpoint_judge_.watch(sample);
    }
  }
  motion_aid_.predict({work.block.data(), work.block.size()},
                      {work.odometer.data(), work.odometer.size()}, work.time, &ekf_);
  motion_aid_.set_carrier_speed(std::nullopt);  // of no use to the next epoch unless told anew
  if (const auto found = motion_aid_.contradiction())
    events_.emit(EventKind::kConstraintsLeftOut, constraint_groups(found->left_out), found->share,
                 work.time);
  for (const ConstraintInstant& instant : motion_aid_.instants())
    if (!before.is_set() || instant.time > before) report_->constraints.push_back(instant);
  report_->constraint_reports = motion_aid_.reports();
  drop_broken_filter(work.time);
  if (!work.empty) {
    use_measurements(work);
    watch_usable();
  }
  drop_broken_filter(work.time);
  watch_heading(work);
  if (gnss_used_) {
    last_gnss_time_ = work.time;
    align(work);
  }
  watch_motion(work);
  check_conventions(work);
  report_solution(work);
  motion_aid_.set_satellites(report_->satellites_used);
  deliver(work);
  watch_orbits();
  publish(work);
  push_keyframe(work);
}

// Last: the smoother may go to work on it at once.
void GnssStage::push_keyframe(const EpochWork& work) {
  if (keyframes_ == nullptr) return motion_aid_.forget();
  keyframe_maker_.add(work.block);
  const bool due = keyframe_maker_.is_due(ekf_, work.time);
  KeyframeInput* keyframe = due ? keyframes_->next_keyframe(work.index) : nullptr;
  if (keyframe == nullptr) {
    if (due) {
      Decision skipped;
      skipped.sequence = next_decision_++;
      skipped.epoch = work.index;
      skipped.time = work.time;
      skipped.mailbox = 2;
      sink_->on_decision(skipped);
    }
    return keyframes_->no_keyframe(report_->solution, due);
  }
  keyframe_maker_.make(work, updated_ ? measurements_.get() : nullptr, &motion_aid_, &ekf_,
                       keyframe);
  keyframe->has_gnss = source() != Source::kInsOnly;
  keyframes_->push_keyframe();
}

void GnssStage::use_measurements(const EpochWork& work) {
  if (!ekf_.initialized()) {
    start_filter(work);
  } else if (prediction_is_useless()) {
    PointSolution point;
    if (solve(work, Eigen::Vector3d::Zero(), &point)) {
      const OutageWatch::Position before = antenna_position();
      restart_from(point, work, ResetCause::kOutage);
      watch_outage(before, work.time);
      report_point(*measurements_, true, point.p_e, report_.get());
    } else {
      report_point(*measurements_, false, Eigen::Vector3d::Zero(), report_.get());
    }
  } else {
    update_filter(work);
  }
}

// Looks at the measurements before any filter, and changes nothing of what follows.
void GnssStage::check_conventions(const EpochWork& work) {
  for (const ImuSample& sample : work.block) convention_check_.add(sample);
  if (work.empty || !convention_check_.is_due(work.time)) return;
  const bool attitude = ekf_.has_attitude() && ekf_.state().time == work.time;
  const auto finding =
      convention_check_.end_second(work.raw, catalog_, attitude ? &ekf_.state().q_eb : nullptr);
  if (finding)
    events_.emit(EventKind::kConventionSuspect, static_cast<std::uint8_t>(finding.convention),
                 finding.value, work.time);
}

// A point solution good enough to start from; its measurements stay in measurements_.
bool GnssStage::solve(const EpochWork& work, const Eigen::Vector3d& approximate_p_e,
                      BandBiases* biases, PointSolution* point) {
  *point = solve_point(work.raw, catalog_, config_.gnss, robust_start(config_.ekf.robust),
                       approximate_p_e, measurements_.get(), biases);
  measurements_->index = work.index;
  return point->status == PointStatus::kOk && point->satellites >= kMinSatellites &&
         point->pdop <= kMaxPdop && point->residual_rms_m <= kMaxResidualRms_m &&
         point->p_e.allFinite() && point->covariance_p_e.allFinite();
}

bool GnssStage::start_filter(const EpochWork& work) {
  PointSolution point;
  const bool solved = solve(work, Eigen::Vector3d::Zero(), &point);
  if (solved) {
    ekf_.initialize(work.time, point);
    gnss_used_ = true;
  }
  report_point(*measurements_, solved, point.p_e, report_.get());
  return solved;
}

PreprocessAids GnssStage::aids() {
  PreprocessAids aids;
  aids.biases = &band_biases_;
  aids.antennas = &antennas_;
  if (config_.ekf.use_carrier) aids.carriers = &carriers_;
  // One to three satellites carry neither a start nor an alignment.
  aids.caps = !inertial_ || ekf_.has_attitude();
  if (ekf_.has_attitude()) {
    C_er_ = ekf_.state().q_eb.toRotationMatrix();
    aids.C_er = &C_er_;
  }
  return aids;
}

// What is known of how far the antenna has moved since the last epoch. The velocity's covariance
// grows over the interval, so its value at the end bounds the change's; the antenna swings about
// the IMU as exactly as the gyros' bias is known.
RangeChangePrior GnssStage::change_prior(bool predicted) const {
  RangeChangePrior prior;
  prior.position_covariance = last_position_covariance_;
  if (!predicted || !carriers_.last_time().is_set()) return prior;
  const double dt = seconds_between(ekf_.state().time, carriers_.last_time());
  prior.change_is_free = false;
  prior.change_covariance = dt * dt * ekf_.antenna_velocity_covariance_e();
  if (ekf_.has_attitude()) {
    const double rate_variance =
        ekf_.covariance().diagonal().segment<3>(ekf_index::kGyroBias).sum() / 3.0;
    prior.change_covariance.diagonal().array() +=
        dt * dt * config_.vehicle.lever_arm_b.squaredNorm() * rate_variance;
  }
  return prior;
}

// Where the measurements are corrected and linearized: as predicted, or where the prediction is too
// vague for centimetres, as the codes alone tell.
Eigen::Vector3d GnssStage::approximate_position(const EpochWork& work) {
  const Eigen::Vector3d predicted_p_e = ekf_.antenna_position_e();
  if (!config_.ekf.use_carrier || position_sigma() < kVagueSigma_m) return predicted_p_e;
  std::swap(measurements_, check_measurements_);
  PointSolution point;
  const bool solved = solve(work, predicted_p_e, &point);
  std::swap(measurements_, check_measurements_);
  return solved ? point.p_e : predicted_p_e;
}

void GnssStage::update_filter(const EpochWork& work) {
  const Eigen::Vector3d approximate_p_e = approximate_position(work);
  preprocess(work.raw, catalog_, config_.gnss, approximate_p_e, measurements_.get(), aids());
  measurements_->index = work.index;
  if (config_.ekf.use_carrier) {
    const bool predicted = approximate_p_e == ekf_.antenna_position_e();
    const RangeChangePrior prior = change_prior(predicted);
    carriers_.check_range_changes(approximate_p_e, prior, measurements_.get());
    if (motion_aid_.asks_carriers()) {
      carrier_speed_.add(carriers_.antenna_change(prior));
      motion_aid_.set_carrier_speed(carrier_speed_.horizontal(approximate_p_e));
    }
  }
  const OutageWatch::Position before = antenna_position();
  const EkfUpdateResult result = ekf_.update(*measurements_);
  updated_ = true;
  if (config_.ekf.use_carrier) {
    carriers_.remember(*measurements_, ekf_.antenna_position_e());
    for (const SatelliteId satellite : result.slipped)
      carriers_.end_arc(satellite, measurements_.get());
    last_position_covariance_ =
        ekf_.covariance().block<3, 3>(ekf_index::kPosition, ekf_index::kPosition);
  }
  gnss_used_ = result.used > 0;
  if (gnss_used_) watch_outage(before, work.time);
  report_update(*measurements_, result, ekf_.antenna_position_e(), report_.get());
  watch_consistency(work, result);
  watch_clocks(result, work.time);
  judge(work, result);
}

OutageWatch::Position GnssStage::antenna_position() const {
  return {ekf_.antenna_position_e(), ekf_.antenna_position_covariance_e()};
}

void GnssStage::watch_outage(const OutageWatch::Position& before, GpsTime time) {
  if (const auto over = outage_watch_.add(time, before, antenna_position()))
    events_.emit(EventKind::kOutageOver,
                 static_cast<std::uint8_t>(std::min(255.0, 10.0 * over->step_sigmas)),
                 over->lasted_s, time);
  if (const auto after_s = outage_watch_.reconverged())
    events_.emit(EventKind::kReconverged, 0, *after_s, time);
}

void GnssStage::process_command(const Command& command) {
  if (command.kind == CommandKind::kSetHeading) return set_heading(command.value, command.sigma);
  ekf_.reset();
  carriers_.reset();
  alignment_.reset();
  motion_aid_.reset();
  forget_judgements();
  outage_watch_.reset();
  last_gnss_time_ = last_reset_time_ = last_lock_out_ = GpsTime();
  convention_check_.clear();
  events_.emit(EventKind::kFilterReset, static_cast<std::uint8_t>(command.cause), 0.0,
               last_epoch_time_);
}

// What is about to be delivered, checked once more as a whole: finite states could be so far out
// that their coordinates are not.
void GnssStage::report_solution(const EpochWork& work) {
  report_state(ekf_, report_.get());
  if (is_finite(report_->solution)) return;
  drop_filter(work.time, ResetCause::kNotFinite, 0.0);
  report_->solution = Solution();
  report_->solution.time = work.time;
}

void GnssStage::deliver(const EpochWork& work) {
  if (!inertial_) return;
  EkfUpdate update;
  update.index = work.index;
  update.valid = ekf_.initialized();
  if (update.valid) {
    update.has_attitude = ekf_.has_attitude();
    update.state = ekf_.state();
    update.covariance = ekf_.covariance().topLeftCorner<ekf_index::kInsSize, ekf_index::kInsSize>();
    update.gnss_used = gnss_used_;
    update.wander = ekf_.whole_state().wander;
    update.time_offset_s = ekf_.has_attitude() ? time_offset_of(ekf_.vehicle()) : 0.0;
  }
  mailbox_->deliver(work.index, update);
}

void GnssStage::publish(const EpochWork& work) {
  report_->solution.source = source();
  report_->alignment = alignment_need();
  report_->checkpoint = checkpoint(work);
  report_->solution.anchor_epoch = work.index;
  report_->sequence = next_report_++;
  if (!inertial_ && keyframes_ == nullptr && ekf_.initialized()) {
    report_->solution.sequence = next_solution_++;
    sink_->on_solution(report_->solution);
  }
  sink_->on_epoch(*report_);
}

void GnssStage::watch_orbits() {
  for (const SatelliteReport& satellite : report_->satellites) {
    const OrbitChange change =
        orbit_watch_.look(satellite.satellite, satellite.source, satellite.clock_of_file);
    if (change == OrbitChange::kNone) continue;
    std::uint64_t& count = orbit_changes_[static_cast<std::size_t>(change)];
    // Events are thinned, so that a product that comes and goes does not drown the others.
    if (++count > 16 && count % 256 != 0) continue;
    events_.emit(event_of(change), static_cast<std::uint8_t>(satellite.satellite.system),
                 satellite.satellite.number, report_->time);
  }
}

Source GnssStage::source() const {
  if (!ekf_.initialized()) return Source::kNone;
  if (inertial_ && !ekf_.has_attitude()) return Source::kAligning;
  const double since_s = seconds_between(last_epoch_time_, last_gnss_time_);
  const bool recent = since_s <= 2.5 * config_.realtime.epoch_interval_s;
  return recent ? Source::kEkf : Source::kInsOnly;
}

}  // namespace leonav
