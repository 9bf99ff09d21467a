// ConstraintMonitor finds that the filter leaves motion constraints out most of the time.
#pragma once
#include <optional>

#include "core/filter/update/motion_constraint.h"

namespace leonav {

// A gate excludes a constraint that is too far from the filter's prediction. Where that happens at
// more than half of the instants of the last ten seconds, the vehicle slides, or is not what the
// configuration describes. The instants are counted by sums that fade with ten seconds.
class ConstraintMonitor {
 public:
  // `interval_s` is the interval of the instants.
  explicit ConstraintMonitor(double interval_s) : interval_s_(interval_s) {}

  void reset();
  // Adds an instant at which these constraints were applied and the filter has used `used`.
  void add(const MotionMeasurements& measurements, MotionComponents used);

  struct Contradiction {
    double share = 0.0;             // share of the instants
    MotionComponents left_out = 0;  // at the last instant that excluded something
  };
  // Returns a contradiction once; again only after the share was below a quarter.
  std::optional<Contradiction> contradiction();

 private:
  double interval_s_;
  double offered_ = 0.0, left_out_ = 0.0;  // fading sums
  MotionComponents last_left_out_ = 0;
  bool contradicted_ = false;
};

}  // namespace leonav
