// EpochReporter publishes the GNSS stage's epoch reports, solutions, decisions and events, each
// kind in one sequence.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/filter/ekf.h"
#include "core/navigator/interface/event_source.h"
#include "core/navigator/interface/output_sink.h"
#include "core/navigator/interface/stage_work.h"
#include "core/navigator/monitors/checkpoint_validity_monitor.h"
#include "core/navigator/monitors/independent_solution.h"
#include "core/navigator/monitors/orbit_source_monitor.h"
#include "core/navigator/monitors/outage_monitor.h"
#include "core/navigator/monitors/usability_monitor.h"
#include "core/vehicle/motion_aiding.h"

namespace leonav {

// EpochReporter reports the decisions of others, and what three monitors find in its reports; none
// of the latter decides anything. Its report is one buffer that each epoch begins anew: call
// start() first and publish() last. Allocates when constructed, not after.
class EpochReporter {
 public:
  explicit EpochReporter(OutputSink* sink);

  // Begins the report of an epoch.
  void start(const EpochWork& work);
  // Adds the motion constraints since `last_epoch` and emits an event for `contradiction`.
  void add_prediction(GpsTime last_epoch, const MotionAiding& motion,
                      const std::optional<ConstraintMonitor::Contradiction>& contradiction);
  // Adds the measurements of a point solution from which the filter has started, or would have
  // started had it been accepted.
  void add_point(const IndependentSolution& solution);
  // Adds the measurements of an update; `filter` is the filter after it.
  void add_update(const MeasurementEpoch& epoch, const EkfUpdateResult& result, const Ekf& filter);
  // Emits an event if no satellite can be used; call it after add_point() or add_update().
  void monitor_usability();
  // Adds the filter's solution and clocks. Clocks that the filter does not estimate keep the values
  // of an earlier call in the same epoch.
  void add_state(const Ekf& filter);
  // Adds the protection levels of the filter's solution, which allow for `faults`, and returns them
  // from this epoch on.
  LevelGrowth add_levels(const Ekf& filter, const FaultHypotheses& faults,
                         const IntegrityConfig& config);
  // Replaces a solution that must not be published by an empty one.
  void clear_solution();
  // Completes the report and passes it to the sink, with `publishes_solution` its solution too.
  void publish(Source source, const AlignmentNeed& alignment,
               const std::optional<Checkpoint>& checkpoint, bool publishes_solution);

  const EpochReport& report() const { return *report_; }

  void emit(EventKind kind, std::uint8_t code, double value, GpsTime time) {
    events_.emit(kind, code, value, time);
  }
  // Emits events for the result of FilterMonitor::add_consistency().
  void report_consistency(const std::array<std::optional<double>, 2>& improbable, GpsTime time);
  void report_clock_steps(const EkfUpdateResult& result, GpsTime time);
  // Emits an event per observable that has widened the prediction's covariance, and one where codes
  // were found to contradict orbits or clocks for minutes.
  void report_contradictions(const EkfUpdateResult& result, GpsTime time);
  // Emits events about outages. An update with satellites has moved the position from `before` to
  // `after`.
  void report_outage(const OutageMonitor::Position& before, const OutageMonitor::Position& after,
                     GpsTime time);
  void reset_outage() { outage_monitor_.reset(); }
  // Emits an event for a verdict on a checkpoint; nullopt: there is none yet.
  void report_checkpoint(const std::optional<CheckpointValidityMonitor::Verdict>& verdict,
                         GpsTime time);
  // Emits events for satellites of this report whose orbit or clock comes from another source than
  // before.
  void report_orbit_changes();
  // Adds how many satellites have a precise orbit that is refused, and emits an event for each of
  // which this begins.
  void report_refused_orbits(int refused, std::span<const SatelliteId> begun, GpsTime time);
  // Records the decision that a keyframe was due but had no room.
  void report_skipped_keyframe(const EpochWork& work);

 private:
  OutputSink* sink_;
  EventSource events_;
  std::unique_ptr<EpochReport> report_;
  std::uint64_t next_report_ = 1, next_solution_ = 1, next_decision_ = 1;
  OrbitSourceMonitor orbit_source_monitor_;
  UsabilityMonitor usability_monitor_;
  OutageMonitor outage_monitor_;
  std::uint64_t orbits_refused_ = 0, clock_steps_ = 0, widened_predictions_ = 0;
  std::array<std::uint64_t, 5> orbit_changes_{};  // occurrences per OrbitChange
};

}  // namespace leonav
