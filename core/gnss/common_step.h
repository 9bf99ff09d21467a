// A step that most of several quantities share: of a clock, as its satellites show it.
#pragma once
#include <cstddef>
#include <optional>
#include <span>

namespace leonav {

struct StepSample {
  double value_m = 0.0;  // what this satellite says of the step
  double sigma_m = 0.0;  // of its own noise: what others do not share
};

struct CommonStep {
  double value_m = 0.0;
  double sigma_m = 0.0;
};

// Fewer do not make a median that two of them cannot move.
inline constexpr std::size_t kMinStepSamples = 4;

// A step is this many times its own sigma. With normal errors one value in two million is by
// chance.
inline constexpr double kStepSignificance = 5.0;
// Variance of the median of n normal values over that of their mean (large n).
inline constexpr double kMedianVariance = 1.5708;  // pi / 2

// The median of `samples`, if it is a step: significant against what all samples share
// (`common_sigma_m`) and their own noise, and with two thirds of them nearer to it than to none.
// The noise is that of the sigmas or of the scatter, whichever is larger. nullopt: none, fewer than
// four samples, or a value that is not finite.
std::optional<CommonStep> find_common_step(std::span<const StepSample> samples,
                                           double common_sigma_m);

}  // namespace leonav
