// FilterMonitor decides from the measurements an update rejects, and from independent solutions,
// whether the filter may go on.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>

#include "core/filter/ekf.h"
#include "core/filter/innovation_tests/consistency_monitor.h"
#include "core/navigator/interface/event.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/monitors/independent_solution.h"
#include "core/navigator/monitors/measurement_rejection_monitor.h"

namespace leonav {

enum class FilterAction : unsigned char {
  kKeep,
  kRestartClocks,  // the clock offsets are estimated anew from the next epoch's codes
  kRestart,        // from FilterVerdict::start
  kDrop,           // the filter is worth nothing, its attitude included
};

struct FilterVerdict {
  FilterAction action = FilterAction::kKeep;
  // Of kRestart and kDrop: of the event that reports it.
  ResetCause cause = ResetCause::kPrediction;
  double value = 0.0;
  // Of kRestart.
  PointSolution start;
  bool keeps_attitude = false;           // less certain of its heading, with the IMU's errors
  bool keeps_vehicle_constants = false;  // what has been estimated of the vehicle
};

// The evidence of one epoch after the filter's update.
struct FilterEvidence {
  GpsTime time;
  const EkfUpdateResult& update;
  const MeasurementEpoch& measurements;  // those of the update
  const Ekf& filter;
};

// Returns verdicts and changes nothing but its own evidence: the caller acts on a verdict, and
// reports that with filter_restarted() or reset(). The three tests of an update are to be called in
// the order test_prediction, test_rejections, test_position, until one has restarted the filter: a
// test may not judge a filter by the update of another one.
class FilterMonitor {
 public:
  explicit FilterMonitor(const NavigatorConfig& config);

  // Drops a filter with a number that is not finite.
  FilterVerdict test_finite(const Ekf& filter) const;

  // True if the prediction of an initialized filter is worse than a point solution. Carrier arcs
  // that go on since `last_gnss` are worth more than any position from codes.
  bool prediction_is_too_uncertain(const Ekf& filter, GpsTime time, GpsTime last_gnss) const;
  // Returns the restart from `point` after such a prediction.
  FilterVerdict restart_after_outage(const PointSolution& point, const Ekf& filter,
                                     GpsTime time) const;

  // Most codes or Dopplers rejected in EkfConfig::reset_epochs epochs in a row: a restart from a
  // point solution that contradicts the filter and has been checked itself. Where the point
  // solution agrees with the filter, the measurements are wrong.
  FilterVerdict test_prediction(const FilterEvidence& evidence, IndependentSolver* solver);
  // Nearly all rejected with too few satellites for a point solution to decide (see
  // MeasurementRejectionMonitor): first a restart from the filter's own position, as uncertain as
  // the two disagree; where that has not helped, or the disagreement is too large, the filter is
  // dropped.
  FilterVerdict test_rejections(const FilterEvidence& evidence);
  // All codes agree on another position, for longer and with more satellites than they have agreed
  // with the filter's: a restart there. A filter that started between walls stays where its
  // carriers hold it.
  FilterVerdict test_position(const FilterEvidence& evidence, IndependentSolver* solver);

  // Codes, Dopplers: the mean ratio of their innovations to their sigmas, if it has just become
  // improbable (ConsistencyMonitor).
  std::array<std::optional<double>, 2> add_consistency(const EkfUpdateResult& update);

  // The evidence for and against a filter is void for the next one.
  void clear_evidence();
  // `time`: of the reset; unset: time begins anew.
  void filter_restarted(GpsTime time) { last_reset_time_ = time; }
  void clear_rejection_time() { last_rejection_restart_ = GpsTime(); }

 private:
  FilterVerdict restart_from(const PointSolution& point, ResetCause cause, const Ekf& filter,
                             GpsTime time) const;
  bool contradicts(const PointSolution& point, const Ekf& filter, GpsTime time, bool motion) const;
  bool motion_supports_point(const PointSolution& point, const Ekf& filter, GpsTime time) const;

  double reset_ratio_, max_arc_gap_s_;
  int reset_epochs_;
  bool use_carrier_;
  MeasurementRejectionMonitor rejection_monitor_;
  std::array<ConsistencyMonitor, 2> consistency_;  // codes, Dopplers
  int contradicted_epochs_ = 0;                    // in a row
  GpsTime first_contradiction_time_;  // of the first of them, if there was a point solution
  PointSolution first_contradiction_point_;
  GpsTime last_position_test_time_;
  // Redundant codes times seconds (s) for another position less those for the filter's.
  double displacement_evidence_ = 0.0;
  Eigen::Vector3d mean_displacement_e_ = Eigen::Vector3d::Zero();  // of point solutions, m
  GpsTime last_reset_time_;
  GpsTime last_rejection_restart_;
};

}  // namespace leonav
