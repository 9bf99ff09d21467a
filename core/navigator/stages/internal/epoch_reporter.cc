#include "core/navigator/stages/internal/epoch_reporter.h"

#include <algorithm>

#include "core/installation_checks/convention.h"
#include "core/navigator/interface/event_limiter.h"
#include "core/navigator/stages/internal/epoch_report.h"

namespace leonav {
namespace {

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

// Returns the code of the event: the sum of side 1, vertical 2, velocity at standstill 4, rate at
// standstill 8, odometer 16.
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

EpochReporter::EpochReporter(OutputSink* sink)
    : sink_(sink), events_(Stage::kGnss, sink), report_(std::make_unique<EpochReport>()) {}

void EpochReporter::start(const EpochWork& work) {
  start_report(work.index, work.time, work.empty, report_.get());
}

void EpochReporter::add_prediction(
    GpsTime last_epoch, const MotionAiding& motion,
    const std::optional<ConstraintMonitor::Contradiction>& contradiction) {
  if (contradiction)
    emit(EventKind::kConstraintsLeftOut, constraint_groups(contradiction->left_out),
         contradiction->share, report_->time);
  for (const ConstraintInstant& instant : motion.instants())
    if (!last_epoch.is_set() || instant.time > last_epoch) report_->constraints.push_back(instant);
  report_->constraint_reports = motion.reports();
}

void EpochReporter::add_point(const IndependentSolution& solution) {
  report_point(*solution.measurements, solution.accepted, solution.point.p_e, report_.get());
}

void EpochReporter::add_update(const MeasurementEpoch& epoch, const EkfUpdateResult& result,
                               const Ekf& filter) {
  report_update(epoch, result, filter.antenna_position_e(), report_.get());
  report_->arcs_joined = result.arcs_joined;
}

void EpochReporter::monitor_usability() {
  const auto finding =
      usability_monitor_.add({report_->satellites.data(), report_->satellites.size()});
  if (finding)
    emit(EventKind::kNoneUsable, static_cast<std::uint8_t>(finding->reason), finding->satellites,
         report_->time);
}

void EpochReporter::add_state(const Ekf& filter) { report_state(filter, report_.get()); }

LevelGrowth EpochReporter::add_levels(const Ekf& filter, const FaultHypotheses& faults,
                                      const IntegrityConfig& config) {
  report_->fault_hypotheses = faults;
  return report_levels(filter, config, report_.get());
}

void EpochReporter::clear_solution() {
  report_->solution = Solution();
  report_->solution.time = report_->time;
}

void EpochReporter::publish(Source source, const AlignmentNeed& alignment,
                            const std::optional<Checkpoint>& checkpoint, bool publishes_solution) {
  report_->solution.source = source;
  report_->alignment = alignment;
  report_->checkpoint = checkpoint;
  report_->solution.anchor_epoch = report_->index;
  report_->sequence = next_report_++;
  if (publishes_solution) {
    report_->solution.sequence = next_solution_++;
    sink_->on_solution(report_->solution);
  }
  sink_->on_epoch(*report_);
}

// A filter that is less accurate than its sigmas for a long time needs attention, even if no
// measurement is an outlier.
void EpochReporter::report_consistency(const std::array<std::optional<double>, 2>& improbable,
                                       GpsTime time) {
  for (const Improbable code : {Improbable::kCodes, Improbable::kDopplers})
    if (const auto& ratio = improbable[static_cast<std::size_t>(code)])
      emit(EventKind::kImprobable, static_cast<std::uint8_t>(code), *ratio, time);
}

// A step that the clock states have taken up costs no accuracy. But users of the receiver's time
// need to know it, and it explains why arcs ended. The clocks of some receivers step every second,
// so the event is thinned.
void EpochReporter::report_clock_steps(const EkfUpdateResult& result, GpsTime time) {
  const auto report_step = [&](std::size_t code, double step_m) {
    if (step_m == 0.0) return;
    if (!is_event_due(++clock_steps_)) return;
    emit(EventKind::kClockStep, static_cast<std::uint8_t>(code), step_m, time);
  };
  report_step(static_cast<std::size_t>(ClockStep::kReceiver),
              result.clock_jump_m - result.code_step_m);
  report_step(static_cast<std::size_t>(ClockStep::kCodes), result.code_step_m);
  for (std::size_t system = 0; system < kMaxSystemTimes; ++system)
    report_step(static_cast<std::size_t>(ClockStep::kFirstSystem) + system,
                result.inter_system_step_m[system]);
}

// An IMU that has failed contradicts every epoch, so that prediction_widened is thinned.
void EpochReporter::report_contradictions(const EkfUpdateResult& result, GpsTime time) {
  for (std::size_t kind = 0; kind < kObservables; ++kind) {
    const double sigma = result.prediction_widened[kind];
    if (!(sigma > 0.0)) continue;
    ++report_->widened_predictions;
    if (is_event_due(++widened_predictions_))
      emit(EventKind::kPredictionWidened, static_cast<std::uint8_t>(kind), sigma, time);
  }
  if (result.lasting_error_found_m > 0.0)
    emit(EventKind::kConventionSuspect, static_cast<std::uint8_t>(Convention::kOrbits),
         result.lasting_error_found_m, time);
}

void EpochReporter::report_outage(const OutageMonitor::Position& before,
                                  const OutageMonitor::Position& after, GpsTime time) {
  if (const auto over = outage_monitor_.add(time, before, after))
    emit(EventKind::kOutageOver,
         static_cast<std::uint8_t>(std::min(255.0, 10.0 * over->step_sigmas)), over->lasted_s,
         time);
  if (const auto after_s = outage_monitor_.reconverged())
    emit(EventKind::kReconverged, 0, *after_s, time);
}

void EpochReporter::report_checkpoint(
    const std::optional<CheckpointValidityMonitor::Verdict>& verdict, GpsTime time) {
  if (!verdict) return;
  emit(EventKind::kCheckpoint, static_cast<std::uint8_t>(verdict->use), verdict->value, time);
}

void EpochReporter::report_orbit_changes() {
  for (const SatelliteReport& satellite : report_->satellites) {
    const OrbitChange change = orbit_source_monitor_.update(satellite.satellite, satellite.source,
                                                            satellite.clock_from_file);
    if (change == OrbitChange::kNone) continue;
    if (!is_event_due(++orbit_changes_[static_cast<std::size_t>(change)])) continue;
    emit(event_of(change), static_cast<std::uint8_t>(satellite.satellite.system),
         satellite.satellite.number, report_->time);
  }
}

void EpochReporter::report_refused_orbits(int refused, std::span<const SatelliteId> begun,
                                          GpsTime time) {
  report_->orbits_refused = refused;
  for (const SatelliteId satellite : begun) {
    if (!is_event_due(++orbits_refused_)) continue;
    emit(EventKind::kOrbitRefused, static_cast<std::uint8_t>(satellite.system), satellite.number,
         time);
  }
}

void EpochReporter::report_skipped_keyframe(const EpochWork& work) {
  Decision skipped;
  skipped.sequence = next_decision_++;
  skipped.epoch = work.index;
  skipped.time = work.time;
  skipped.subject = Decision::Subject::kKeyframe;
  sink_->on_decision(skipped);
}

}  // namespace leonav
