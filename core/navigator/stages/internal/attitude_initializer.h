// AttitudeInitializer finds the filter's first attitude and later decides whether its heading is
// still right.
#pragma once
#include <Eigen/Geometry>
#include <optional>

#include "core/filter/ekf.h"
#include "core/inertial/alignment/alignment.h"
#include "core/inertial/alignment/external_heading.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/stage_work.h"
#include "core/navigator/monitors/checkpoint_validity_monitor.h"
#include "core/navigator/monitors/heading_monitor.h"
#include "core/navigator/monitors/independent_solution.h"

namespace leonav {

// Returns by how much the heading turns, rad, from `state` to `until`, by the samples' angular
// rates without their estimated errors; the Earth's rate is left out, so that it serves for some
// seconds. Samples before `state` do not count.
double heading_change(const NavState& state, const ImuBlock& samples, GpsTime until);

// AttitudeInitializer only reads the filter. The caller sets the attitudes that it returns and
// reports the verdicts on a checkpoint. A heading comes from outside (configuration or command),
// from an earlier run's checkpoint, or from alignment. Without an inertial motion model it does
// nothing.
class AttitudeInitializer {
 public:
  using CheckpointVerdict = CheckpointValidityMonitor::Verdict;

  explicit AttitudeInitializer(const NavigatorConfig& config);

  // Adds the samples of an epoch, before the filter's prediction over them.
  void add(const ImuBlock& block, const Ekf& filter);

  // Returns whether the epoch's block ends at its time and the filter still has no attitude.
  bool is_due(const EpochWork& work, const Ekf& filter) const;
  // If due, call this first. It returns the verdict on a pending checkpoint, once there is one. The
  // heading of a checkpoint that may be used then serves first_attitude() in the same epoch.
  std::optional<CheckpointVerdict> evaluate_checkpoint(GpsTime time, const Ekf& filter);
  // The first attitude and whether its heading came from outside.
  struct FirstAttitude {
    AlignedAttitude aligned;
    bool heading_given = false;
  };
  // If due, call this second. It returns the attitude once it is found.
  std::optional<FirstAttitude> first_attitude(const Ekf& filter);
  // Call both once the filter has the attitude. The heading is monitored from then on.
  // discard_checkpoint() returns the verdict kNotNeeded on a checkpoint that is still pending, else
  // nullopt.
  void start_heading_monitor(const Ekf& filter);
  std::optional<CheckpointVerdict> discard_checkpoint();

  void take_checkpoint(const Checkpoint& checkpoint) { checkpoint_monitor_.take(checkpoint); }

  // The filter's attitude, turned about the vertical.
  struct TurnedAttitude {
    Eigen::Quaterniond q_eb;
    Eigen::Vector3d sigma_rpy;  // rad
  };
  // Returns whether the vehicle drives in another direction than this heading, forward or in
  // reverse, by more than three sigmas and what its body may be turned against the antenna's
  // velocity: 45 degrees, and on wheels 24 at 10 m/s and 19 at 15 m/s. False while its velocity is
  // not known, and for what may move in any direction.
  bool contradicts_motion(double heading, double sigma, const Ekf& filter) const;
  // Takes a heading and its sigma, rad, from a command. If the filter has an attitude, it returns
  // that attitude turned to the heading; else it keeps the heading for the alignment and returns
  // nullopt.
  std::optional<TurnedAttitude> set_heading(double heading, double sigma, const Ekf& filter);

  // Adds the epoch's samples to the heading monitor and returns whether it needs an independent
  // velocity now. `updated` states whether the filter was updated with this epoch's measurements.
  bool monitor_heading(const EpochWork& work, const Ekf& filter, bool updated);
  // Returns the error of the filter's heading, rad, once it is significant (HeadingMonitor).
  std::optional<double> heading_error(const IndependentSolution& solution, const Ekf& filter);

  // Call it after the epoch's update. A heading from outside that was used remains valid only while
  // the vehicle has not moved since.
  void monitor_motion(const EpochWork& work, const Ekf& filter);

  // Returns what the alignment still lacks. `latitude` is the filter's, rad.
  AlignmentNeed need(const Ekf& filter, double latitude) const;

  void reset_alignment() { alignment_.reset(); }
  // Stops the heading monitor and drops a heading from outside that has proved wrong.
  void forget_heading();

 private:
  AlignmentConfig config_;
  bool inertial_;
  Alignment alignment_;
  ExternalHeading external_heading_;
  HeadingMonitor heading_monitor_;
  CheckpointValidityMonitor checkpoint_monitor_;
};

}  // namespace leonav
