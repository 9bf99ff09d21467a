// ProcessPropagation integrates the IMU block between two keyframes, from an estimate that need not
// be the filter's.
#pragma once
#include <memory>
#include <span>

#include "core/filter/estimate/inertial_propagator.h"
#include "core/filter/estimate/state_estimate.h"
#include "core/filter/update/motion_constraint.h"
#include "core/inertial/strapdown/imu.h"

namespace leonav {

struct ProcessPropagationConfig {
  EkfConfig ekf;
  ImuErrorModel imu;
  MotionConstraintConfig motion;
};

// Allocates when constructed, not after.
class ProcessPropagation {
 public:
  explicit ProcessPropagation(const ProcessPropagationConfig& config);

  // Integrates `block` from `from`, which is taken as certain and has an attitude, to `to`, with
  // the motion constraints that the filter has used at `instants`. `before_block` is the last
  // sample measured before the block. The result, until the next call: the state with its process
  // F, N since `from` and, where there were constraints, what they say about `from`
  // (core/filter/state/filter_process.h). Clocks and delays of the atmosphere stay as they are.
  const StateEstimate& operator()(const CoreState& from, const ImuSample& before_block,
                                  std::span<const ImuSample> block,
                                  std::span<const ConstraintInstant> instants, GpsTime to);
  // Returns the motion of the body at the end of the last call.
  const BodyMotion& body() const { return propagator_.body(); }

 private:
  MotionConstraintConfig motion_;
  MotionMeasurements measurements_;
  std::unique_ptr<StateEstimate> estimate_;
  InertialPropagator propagator_;
};

// Returns where the process alone leads: the state without the corrections by motion constraints.
CoreState uncorrected_state(const StateEstimate& propagated);

}  // namespace leonav
