// FilterMonitor decides whether the filter may go on, from the measurements that an update rejects
// and from independent solutions.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>

#include "core/filter/ekf.h"
#include "core/navigator/interface/event.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/monitors/consistency_monitor.h"
#include "core/navigator/monitors/independent_solution.h"
#include "core/navigator/monitors/measurement_rejection_monitor.h"

namespace leonav {

// The action that a verdict requests.
enum class FilterAction : unsigned char {
  kKeep,
  kRestartClocks,  // the clock offsets are estimated anew from the next epoch's codes
  kRestart,        // the filter restarts from FilterVerdict::start
  kDrop,           // nothing of the filter can be used, not even its attitude
};

// A verdict on the filter. The caller acts on it.
struct FilterVerdict {
  FilterAction action = FilterAction::kKeep;
  // For kRestart and kDrop: code and value of the event that reports the reset (ResetCause).
  ResetCause cause = ResetCause::kPrediction;
  double value = 0.0;
  // For kRestart: position, velocity and clocks to start from.
  PointSolution start;
  bool keeps_attitude = false;           // with the IMU's errors, and a larger sigma of the heading
  bool keeps_vehicle_constants = false;  // the estimated vehicle constants are kept
};

// The evidence of one epoch after the filter's update. It refers to the caller's objects.
struct FilterEvidence {
  GpsTime time;
  const EkfUpdateResult& update;
  const MeasurementEpoch& measurements;  // that the update has used
  const Ekf& filter;                     // after the update
};

// FilterMonitor returns verdicts and changes nothing but its own evidence. The caller acts on a
// verdict and then calls filter_restarted(). After an update call the three tests in the order
// test_prediction, test_rejections, test_position, until one has restarted the filter: a test must
// not decide about a filter by the update of another one.
class FilterMonitor {
 public:
  explicit FilterMonitor(const NavigatorConfig& config);

  // Returns kDrop if a number of the filter is not finite.
  FilterVerdict test_finite(const Ekf& filter) const;

  // Returns whether the prediction of an initialized filter is so uncertain that a point solution
  // is better: a 3D sigma from 500 m on. While carrier arcs may continue since `last_gnss`, the
  // limit is 100 km, because they bridge the outage better than any position from codes.
  bool prediction_is_too_uncertain(const Ekf& filter, GpsTime time, GpsTime last_gnss) const;
  // Returns, after such a prediction, the restart from `point`.
  FilterVerdict restart_after_outage(const PointSolution& point, const Ekf& filter,
                                     GpsTime time) const;

  // Tests whether most codes or Dopplers were rejected in EkfConfig::reset_epochs epochs in a row.
  // The verdict is then a restart from a point solution, if that has enough redundancy and
  // contradicts the filter. If it agrees with the filter, the measurements are wrong.
  FilterVerdict test_prediction(const FilterEvidence& evidence, IndependentSolver* solver);
  // Tests whether nearly all measurements are rejected while too few satellites are left for a
  // point solution to decide (MeasurementRejectionMonitor). The first verdict is a restart from the
  // filter's own position, with a sigma as large as the discrepancy. If that has not helped, or the
  // discrepancy is too large, the filter is dropped.
  FilterVerdict test_rejections(const FilterEvidence& evidence);
  // Tests whether all codes agree on another position, for longer and with more satellites than
  // they have agreed on the filter's. The verdict is then a restart there. This finds a filter that
  // started from reflected signals and whose carriers now keep it at the wrong position.
  FilterVerdict test_position(const FilterEvidence& evidence, IndependentSolver* solver);

  // Adds an update and returns, for codes and for Dopplers, the mean ratio of innovations to sigmas
  // if it has just become improbable (ConsistencyMonitor), else nullopt.
  std::array<std::optional<double>, 2> add_consistency(const EkfUpdateResult& update);

  // Records that the filter was restarted or dropped at `time`, and clears the evidence.
  void filter_restarted(GpsTime time);
  // Clears the evidence, and forgets when the filter was last restarted: a new time base has begun,
  // and its times cannot be compared with earlier ones.
  void time_begins_anew();
  // Clears the evidence that the three tests have collected about the filter as it was. The means
  // of add_consistency() stay, because they tell of the receiver and not of the filter.
  void clear_evidence();

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
  // Point solution of the first of them; the time is unset if it was not reliable.
  GpsTime first_contradiction_time_;
  PointSolution first_contradiction_point_;
  GpsTime last_position_test_time_;
  // Redundant codes times seconds for another position, minus those for the filter's. Unit: s.
  double displacement_evidence_ = 0.0;
  // Mean of point solution minus filter, ECEF, m.
  Eigen::Vector3d mean_displacement_e_ = Eigen::Vector3d::Zero();
  GpsTime last_reset_time_;
  GpsTime last_rejection_restart_;
};

}  // namespace leonav
