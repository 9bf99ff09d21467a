#include "core/robust/common_step.h"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "core/base/capacity.h"
#include "core/base/median.h"

namespace leonav {
namespace {

using Values = boost::container::static_vector<double, kMaxMeasurements>;

constexpr double kMadToSigma = 1.4826;

}  // namespace

bool two_thirds_share(std::span<const double> values, double step) {
  const auto sharing = std::count_if(values.begin(), values.end(), [step](double value) {
    return std::abs(value - step) < std::abs(value);
  });
  return 3 * static_cast<std::size_t>(sharing) >= 2 * values.size();
}

std::optional<CommonStep> find_common_step(std::span<const StepSample> samples,
                                           double common_sigma_m) {
  if (samples.size() < kMinStepSamples || !std::isfinite(common_sigma_m)) return std::nullopt;
  Values values, sigmas;
  for (const StepSample& sample : samples.first(std::min(samples.size(), values.capacity()))) {
    if (!std::isfinite(sample.value_m) || !std::isfinite(sample.sigma_m)) return std::nullopt;
    values.push_back(sample.value_m);
    sigmas.push_back(sample.sigma_m);
  }
  CommonStep step;
  step.value_m = median(values);
  Values deviations;
  for (const double value : values) deviations.push_back(std::abs(value - step.value_m));
  const double scatter_m = kMadToSigma * median(deviations);
  const double noise_m = std::max(median(sigmas), scatter_m);
  const double share = kMedianVariance / static_cast<double>(values.size());
  step.sigma_m = std::sqrt(common_sigma_m * common_sigma_m + share * noise_m * noise_m);
  const bool shared = two_thirds_share({values.data(), values.size()}, step.value_m);
  if (!shared || !(std::abs(step.value_m) > kStepSignificance * step.sigma_m)) return std::nullopt;
  return step;
}

}  // namespace leonav
