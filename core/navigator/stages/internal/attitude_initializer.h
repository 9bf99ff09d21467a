// AttitudeInitializer finds the filter's first attitude, and decides later whether its heading is
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

// Reads the filter and changes nothing of it: the caller gives the attitudes that it returns to the
// filter and reports the verdicts on a checkpoint. Sources of a heading: a given one (configuration
// or command), an earlier run's checkpoint, and alignment. Without an inertial model it does
// nothing.
class AttitudeInitializer {
 public:
  using CheckpointVerdict = CheckpointValidityMonitor::Verdict;

  explicit AttitudeInitializer(const NavigatorConfig& config);

  // The samples of an epoch before the prediction over them.
  void add(const ImuBlock& block, const Ekf& filter);

  // Whether the epoch's block ends at its time and the filter still lacks an attitude.
  bool is_due(const EpochWork& work, const Ekf& filter) const;
  // If due, first: the verdict on a pending checkpoint, once there is one. A checkpoint that may be
  // used gives its heading to the attitude of this epoch.
  std::optional<CheckpointVerdict> evaluate_checkpoint(GpsTime time, const Ekf& filter);
  // If due: the attitude, once there is one.
  struct FirstAttitude {
    AlignedAttitude aligned;
    bool heading_given = false;
  };
  std::optional<FirstAttitude> first_attitude(const Ekf& filter);
  // The filter has the attitude now: its heading is monitored from here, and a checkpoint that is
  // still pending is not needed (the verdict).
  void start_heading_monitor(const Ekf& filter);
  std::optional<CheckpointVerdict> discard_checkpoint();

  void take_checkpoint(const Checkpoint& checkpoint) { checkpoint_monitor_.take(checkpoint); }

  // A heading and its sigma, rad, by command: kept for the alignment, or, where the filter has an
  // attitude, the attitude turned about the vertical.
  struct TurnedAttitude {
    Eigen::Quaterniond q_eb;
    Eigen::Vector3d sigma_rpy;  // rad
  };
  std::optional<TurnedAttitude> set_heading(double heading, double sigma, const Ekf& filter);

  // The heading monitor takes the epoch's samples; true: it needs an independent velocity now.
  // `updated`: the filter has had this epoch's measurements.
  bool monitor_heading(const EpochWork& work, const Ekf& filter, bool updated);
  // By how much the filter's heading is wrong, rad, once that is beyond chance.
  std::optional<double> heading_error(const IndependentSolution& solution, const Ekf& filter);

  // After the epoch's update: a given heading that has been used remains valid only while the
  // vehicle has not moved since.
  void monitor_motion(const EpochWork& work, const Ekf& filter);

  // `latitude`: rad, of the filter.
  AlignmentNeed need(const Ekf& filter, double latitude) const;

  void reset_alignment() { alignment_.reset(); }
  // A heading that has proved wrong is not used again.
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
