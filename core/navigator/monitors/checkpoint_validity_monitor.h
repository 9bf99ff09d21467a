// CheckpointValidityMonitor decides whether the heading of an earlier run's checkpoint still holds.
#pragma once
#include <optional>

#include "core/inertial/alignment/alignment.h"
#include "core/navigator/interface/checkpoint.h"

namespace leonav {

// A parked vehicle keeps its heading, but between two runs no sensor has shown that it stayed
// parked. The monitor therefore requires that the first good position agrees with the checkpoint
// and that the vehicle has not moved since the start. A vehicle that was turned in place meanwhile
// (a turntable, a tow) passes; HeadingMonitor finds that once it drives.
class CheckpointValidityMonitor {
 public:
  // `rate_sigma`: 1 sigma of the rate that the gyros measure at rest, rad/s. `max_age_s`: largest
  // age of a checkpoint, data time.
  CheckpointValidityMonitor(const AlignmentConfig& config, double rate_sigma, double max_age_s)
      : config_(config), rate_sigma_(rate_sigma), max_age_s_(max_age_s) {}

  // Takes a checkpoint and replaces one without a verdict.
  void take(const Checkpoint& checkpoint);
  // Returns whether there is a checkpoint without a verdict.
  bool pending() const { return checkpoint_.has_value(); }

  // Adds a sample; call it with all samples of the run, in order. A vehicle that has turned once is
  // no longer parked as it was.
  void add(const ImuSample& sample);

  // The antenna's motion by a filter that has no attitude yet.
  struct Filter {
    GpsTime time;
    Eigen::Vector3d p_e;   // m, ECEF
    double sigma_p = 0.0;  // m, 3D
    double speed = 0.0;    // m/s, 3D
    double sigma_v = 0.0;  // m/s, per component
  };
  // The use to make of the checkpoint.
  struct Verdict {
    CheckpointUse use;
    double value;                      // see CheckpointUse
    ExternalHeading::Heading heading;  // valid for kUsed
  };
  // Returns the verdict on the pending checkpoint, which is then pending no longer. nullopt:
  // nothing is pending, or position and speed are still too uncertain.
  std::optional<Verdict> evaluate(const Filter& filter);
  // Drops the pending checkpoint, because there is a heading already, and returns kNotNeeded.
  Verdict not_needed();

 private:
  std::optional<Verdict> verdict(const Filter& filter) const;

  AlignmentConfig config_;
  double rate_sigma_, max_age_s_;
  std::optional<Checkpoint> checkpoint_;
  bool turned_ = false;
  GpsTime last_;
  double all_s_ = 0.0;  // duration of all samples
  // Rotation over all samples.
  Eigen::Quaterniond all_turn_ = Eigen::Quaterniond::Identity();
  double window_s_ = 0.0;                                  // duration of the current window
  Eigen::Vector3d window_turn_ = Eigen::Vector3d::Zero();  // rotation over it, rad
};

}  // namespace leonav
