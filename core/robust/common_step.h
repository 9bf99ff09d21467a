// This unit finds a step that most of several samples share, such as the step of a clock in the
// ranges of all satellites.
#pragma once
#include <cstddef>
#include <optional>
#include <span>

namespace leonav {

// One satellite's sample of the step.
struct StepSample {
  double value_m = 0.0;  // the step as this satellite shows it
  double sigma_m = 0.0;  // 1 sigma of this satellite's own noise, which the others do not share
};

// The step with 1 sigma.
struct CommonStep {
  double value_m = 0.0;
  double sigma_m = 0.0;
};

// With fewer samples, two of them could move the median.
inline constexpr std::size_t kMinStepSamples = 4;

// A step must exceed this many times its own sigma. With normal errors one value in two million
// does so by chance.
inline constexpr double kStepSignificance = 5.0;
// Ratio of the variance of the median of n normal values to that of their mean (large n).
inline constexpr double kMedianVariance = 1.5708;  // pi / 2

// Returns whether two thirds of the values are nearer to `step` than to zero.
bool two_thirds_share(std::span<const double> values, double step);

// Returns the median of `samples` if it is a step. It must be significant against the error that
// all samples share (`common_sigma_m`) and their own noise, and two_thirds_share() of the
// samples must hold. The noise is the larger one of the stated sigmas and the scatter.
// Returns nullopt where there is no step, for fewer than four samples, or for a value that is not
// finite.
std::optional<CommonStep> find_common_step(std::span<const StepSample> samples,
                                           double common_sigma_m);

}  // namespace leonav
