// Whether the heading of an earlier run's checkpoint still holds.
#pragma once
#include <optional>

#include "core/inertial/alignment/alignment.h"
#include "core/navigator/interface/checkpoint.h"

namespace leonav {

// A parked vehicle keeps its heading. That it is parked still, nobody has watched: it must be where
// it was, as far as the first good position can tell, and must not have moved since the start.
// Turned in place meanwhile (a turntable, a tow) it passes; HeadingMonitor finds that.
class CheckpointValidityMonitor {
 public:
  // `rate_sigma`: of what gyros at rest show, rad/s; `max_age_s`: of data time.
  CheckpointValidityMonitor(const AlignmentConfig& config, double rate_sigma, double max_age_s)
      : config_(config), rate_sigma_(rate_sigma), max_age_s_(max_age_s) {}

  // Replaces one that has not been judged yet.
  void take(const Checkpoint& checkpoint);
  bool pending() const { return checkpoint_.has_value(); }

  // All samples of the run, in order: what has turned once stands no more where it stood.
  void add(const ImuSample& sample);

  // Of the antenna, by a filter that has no attitude yet.
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
  // nullopt: nothing pending, or position and speed cannot tell yet. After a verdict nothing is
  // pending any more.
  std::optional<Verdict> evaluate(const Filter& filter);
  // There is a heading from elsewhere.
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
