// EpochReporter publishes the GNSS stage's epoch reports, solutions, decisions and events, each
// kind in one sequence.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>

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

// Reads what others have decided and computes nothing for them. The report is one buffer that each
// epoch begins anew: start() first, publish() last. Allocates when constructed, not after.
class EpochReporter {
 public:
  explicit EpochReporter(OutputSink* sink);

  void start(const EpochWork& work);
  // The constraints that acted on the prediction since `last_epoch`, and whether they contradict
  // the motion.
  void add_prediction(GpsTime last_epoch, MotionAiding* motion);
  // The measurements of a point solution from which the filter has started, or, where it is not
  // accepted, would have.
  void add_point(const IndependentSolution& solution);
  // The measurements of an update, with the filter after it.
  void add_update(const MeasurementEpoch& epoch, const EkfUpdateResult& result, const Ekf& filter);
  // After add_point() or add_update(): whether any satellite can be used.
  void monitor_usability();
  // The filter's solution and clocks. Clocks that the filter does not estimate stay in the report
  // as an earlier call of this epoch has left them.
  void add_state(const Ekf& filter);
  // Replaces a solution that may not be published.
  void clear_solution();
  // Completes the report and passes it on; `publishes_solution`: its solution as well.
  void publish(Source source, const AlignmentNeed& alignment,
               const std::optional<Checkpoint>& checkpoint, bool publishes_solution);

  const EpochReport& report() const { return *report_; }

  void emit(EventKind kind, std::uint8_t code, double value, GpsTime time) {
    events_.emit(kind, code, value, time);
  }
  // Of FilterMonitor::add_consistency().
  void report_consistency(const std::array<std::optional<double>, 2>& improbable, GpsTime time);
  void report_clock_steps(const EkfUpdateResult& result, GpsTime time);
  // An update with satellites has moved the position from `before` to `after`.
  void report_outage(const OutageMonitor::Position& before, const OutageMonitor::Position& after,
                     GpsTime time);
  void reset_outage() { outage_monitor_.reset(); }
  // nullopt: no verdict yet.
  void report_checkpoint(const std::optional<CheckpointValidityMonitor::Verdict>& verdict,
                         GpsTime time);
  // Satellites of this report whose orbit or clock comes from another source than before.
  void report_orbit_changes();
  // A keyframe was due and had no room.
  void report_skipped_keyframe(const EpochWork& work);

 private:
  OutputSink* sink_;
  EventSource events_;
  std::unique_ptr<EpochReport> report_;
  std::uint64_t next_report_ = 1, next_solution_ = 1, next_decision_ = 1;
  OrbitSourceMonitor orbit_source_monitor_;
  UsabilityMonitor usability_monitor_;
  OutageMonitor outage_monitor_;
  std::uint64_t clock_steps_ = 0;
  std::array<std::uint64_t, 5> orbit_changes_{};  // per OrbitChange
};

}  // namespace leonav
