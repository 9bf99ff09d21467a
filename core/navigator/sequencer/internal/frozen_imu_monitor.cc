#include "core/navigator/sequencer/internal/frozen_imu_monitor.h"

#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

// Where a sender multiplies rates by intervals that jitter, increments of equal rates differ by
// rounding.
constexpr double kRounding = 1e-12;

}  // namespace

bool FrozenImuMonitor::add(const ImuSample& sample) {
  Rates rates;
  rates << sample.delta_theta_b, sample.delta_velocity_b;
  rates /= sample.interval_s();
  const bool repeats =
      begin_.is_set() && ((rates - rates_).array().abs() <= kRounding * rates_.array().abs()).all();
  if (repeats) {
    ++run_;
    frozen_ =
        frozen_ || (run_ >= std::max(kMinRun, kTimesLongest * longest_run_) &&
                    nanoseconds_between(sample.time, begin_) >= kMinRunNs && has_shown_noise());
    return frozen_;
  }
  // A run that was found to be a fault says nothing about the sensor.
  if (!frozen_) longest_run_ = std::max(longest_run_, run_);
  if (begin_.is_set()) learn((rates - rates_).tail<3>());
  rates_ = rates;
  begin_ = sample.time;
  run_ = 1;
  frozen_ = false;
  return false;
}

void FrozenImuMonitor::learn(const Eigen::Vector3d& step) {
  bool turns_back = false;
  for (int i = 0; i < 3; ++i) {
    const double size = std::abs(step[i]);
    if (size >= kDigit && size <= kFineStep) ++fine_steps_;
    turns_back =
        turns_back || (step[i] * step_[i] < 0.0 && std::min(size, std::abs(step_[i])) >= kNoise);
  }
  ++samples_;
  if (turns_back) ++reversals_;
  step_ = step;
}

bool FrozenImuMonitor::has_shown_noise() const {
  return samples_ >= kMinSamples && fine_steps_ >= kMinFineSteps &&
         kSamplesPerReversal * reversals_ >= samples_;
}

}  // namespace leonav
