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

// Returns whether the propagation moves a state (of ekf_index): all but clocks and delays.
bool is_of_motion(int state);
// Returns whether a factor linearized at `from` must be integrated again because its keyframe is
// now at `state`.
bool is_far(const CoreState& state, const CoreState& from);
// Returns the variance of a clock, drift or delay behind a restart of the filter, SI units: clocks
// begin anew, and delays have hardly changed.
double restarted_variance(int state);
// Keyframes further apart are not connected by the IMU alone.
inline constexpr double kLongestBridge_s = 10.0;

// Returns where the process alone leads: the state without the corrections by motion constraints.
CoreState uncorrected_state(const StateEstimate& propagated);

}  // namespace leonav
