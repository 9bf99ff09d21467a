#include "core/smoother/process_propagation.h"

#include <algorithm>
#include <limits>

#include "core/base/square.h"

namespace leonav {
namespace {

using namespace ekf_index;

// An attitude off by this turns 1 g of specific force over a second into 5e-6 m/s beyond the first
// order; a scale of 1e-3 beside it does less.
constexpr double kFarAttitude = 1e-3;   // rad
constexpr double kFarVelocity = 5.0;    // m/s
constexpr double kFarPosition = 100.0;  // m

constexpr double kUnknownClock = 1e6;    // m
constexpr double kUnknownDrift = 1e3;    // m/s
constexpr double kRestartedDelay = 0.1;  // m

EkfConfig propagating(EkfConfig config) {
  config.keep_process = true;
  return config;
}

}  // namespace

ProcessPropagation::ProcessPropagation(const ProcessPropagationConfig& config)
    : motion_(config.motion),
      estimate_(std::make_unique<StateEstimate>(propagating(config.ekf))),
      propagator_(config.ekf, config.imu) {}

const StateEstimate& ProcessPropagation::operator()(const CoreState& from,
                                                    const ImuSample& before_block,
                                                    std::span<const ImuSample> block,
                                                    std::span<const ConstraintInstant> instants,
                                                    GpsTime to) {
  estimate_->set_exactly(from, true);
  propagator_.restart(from.nav, before_block);
  for (const ConstraintInstant& instant : instants) {
    // Samples that lie behind the estimate already are skipped.
    propagator_.predict(block, instant.time, estimate_.get());
    motion_measurements(motion_, instant, estimate_->state(), propagator_.body().measured_rate_b,
                        &measurements_);
    const auto unused = [&](const MotionMeasurement& measurement) {
      return (instant.used >> measurement.component & 1) == 0;
    };
    measurements_.erase(std::remove_if(measurements_.begin(), measurements_.end(), unused),
                        measurements_.end());
    estimate_->constrain(&measurements_, std::numeric_limits<double>::infinity());
  }
  propagator_.predict(block, to, estimate_.get());
  return *estimate_;
}

bool is_of_motion(int state) { return state < kInsSize || state >= kSize; }

bool is_far(const CoreState& state, const CoreState& from) {
  const EkfCorrection moved = difference(state, from);
  return moved.segment<3>(kAttitude).norm() > kFarAttitude ||
         moved.segment<3>(kVelocity).norm() > kFarVelocity ||
         moved.segment<3>(kPosition).norm() > kFarPosition;
}

double restarted_variance(int state) {
  if (state < kClockDrift) return square(kUnknownClock);
  return state < kWetDelay ? square(kUnknownDrift) : square(kRestartedDelay);
}

CoreState uncorrected_state(const StateEstimate& propagated) {
  CoreState state = propagated.state();
  const FilterProcess& process = propagated.process();
  if (process.has_information) add(process.transition.rightCols<1>(), true, &state);
  return state;
}

}  // namespace leonav
