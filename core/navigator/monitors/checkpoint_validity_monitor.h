// CheckpointValidityMonitor decides whether the heading of an earlier run's checkpoint still holds.
#pragma once
#include <optional>

#include "core/inertial/alignment/alignment.h"
#include "core/navigator/interface/checkpoint.h"

namespace leonav {

// A parked vehicle keeps its heading. Nothing watched it between the runs, so the first good
// position must agree with the checkpoint's, and the vehicle must not have moved since the start. A
// vehicle turned in place meanwhile (a turntable, a tow) passes; HeadingMonitor finds that.
class CheckpointValidityMonitor {
 public:
  // `rate_sigma`: of the rate that gyros measure at rest, rad/s. `max_age_s`: in data time.
  CheckpointValidityMonitor(const AlignmentConfig& config, double rate_sigma, double max_age_s)
      : config_(config), rate_sigma_(rate_sigma), max_age_s_(max_age_s) {}

  // Takes a checkpoint; it replaces one without a verdict.
  void take(const Checkpoint& checkpoint);
  bool pending() const { return checkpoint_.has_value(); }

  // Adds every sample of the run, in order: a vehicle that has turned no longer stands as it stood.
  void add(const ImuSample& sample);

  // The antenna's position and speed by a filter that has no attitude yet.
  struct Filter {
    GpsTime time;
    Eigen::Vector3d p_e;
    double sigma_p = 0.0;  // m, 3D
    double speed = 0.0;    // m/s, 3D
    double sigma_v = 0.0;  // m/s, per component
  };
  struct Verdict {
    CheckpointUse use;
    double value;
    ExternalHeading::Heading heading;  // if kUsed
  };
  // Returns nullopt if nothing is pending, or position and speed are not good enough yet. After a
  // verdict nothing is pending any more.
  std::optional<Verdict> evaluate(const Filter& filter);
  // Ends what is pending, because the heading was found in another way.
  Verdict not_needed();

 private:
  std::optional<Verdict> verdict(const Filter& filter) const;

  AlignmentConfig config_;
  double rate_sigma_, max_age_s_;
  std::optional<Checkpoint> checkpoint_;
  bool turned_ = false;
  GpsTime last_;
  double all_s_ = 0.0;  // of samples
  Eigen::Quaterniond all_turn_ = Eigen::Quaterniond::Identity();
  double window_s_ = 0.0;
  Eigen::Vector3d window_turn_ = Eigen::Vector3d::Zero();  // rad
};

}  // namespace leonav
