#include "core/smoother/process_propagation.h"

#include <algorithm>
#include <limits>

namespace leonav {
namespace {

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

CoreState uncorrected_state(const StateEstimate& propagated) {
  CoreState state = propagated.state();
  const FilterProcess& process = propagated.process();
  if (process.has_information) add(process.transition.rightCols<1>(), true, &state);
  return state;
}

}  // namespace leonav
