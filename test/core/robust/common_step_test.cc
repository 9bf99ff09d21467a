#include "core/robust/common_step.h"

#include <array>
#include <limits>
#include <random>
#include <vector>

#include "support/catch.h"

namespace leonav {
namespace {

std::vector<StepSample> samples_of(const std::vector<double>& values, double sigma_m) {
  std::vector<StepSample> samples;
  for (const double value : values) samples.push_back({value, sigma_m});
  return samples;
}

}  // namespace

TEST_CASE("a step is what two thirds share, beyond their noise") {
  const auto step = find_common_step(samples_of({3.1, 2.8, 3.0, 3.3, -0.2, 2.9}, 0.5), 0.05);
  REQUIRE(step);
  CHECK(step->value_m == Approx(2.95));
  // The sigmas' 0.5 m over the root of six, times that of pi / 2.
  CHECK(step->sigma_m == Approx(std::sqrt(0.05 * 0.05 + 1.5708 / 6.0 * 0.25)));
  // Half of them: one system's clock, or outliers.
  CHECK_FALSE(find_common_step(samples_of({3.1, 2.8, 3.0, 0.1, -0.2, 0.2}, 0.1), 0.0));
  // All of them, but no more than their noise or what they have in common may be.
  CHECK_FALSE(find_common_step(samples_of({3.1, 2.8, 3.0, 3.3, 2.9, 2.7}, 1.5), 0.0));
  CHECK_FALSE(find_common_step(samples_of({3.1, 2.8, 3.0, 3.3, 2.9, 2.7}, 0.1), 1.0));
  // Scatter counts where it is more than the sigmas say.
  CHECK_FALSE(find_common_step(samples_of({3.0, 9.0, 1.7, 3.1, 8.0, 2.0}, 0.1), 0.0));
  CHECK_FALSE(find_common_step(samples_of({3.0, 3.0, 3.0}, 0.1), 0.0));
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(find_common_step(samples_of({3.0, 3.0, 3.0, 3.0, kNaN}, 0.1), 0.0));
  CHECK_FALSE(find_common_step(samples_of({3.0, 3.0, 3.0, 3.0}, 0.1), kNaN));
  CHECK_FALSE(find_common_step({}, 0.0));
}

TEST_CASE("noise alone makes no step: four to twenty satellites, half a million epochs") {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  for (const std::size_t count : {4u, 5u, 7u, 8u, 12u, 20u}) {
    for (const double stated : {1.0, 4.0}) {  // sigmas as they are, and with a standing part
      int found = 0;
      std::vector<StepSample> samples(count);
      for (int k = 0; k < 40'000; ++k) {
        for (StepSample& sample : samples) sample = {normal(generator), stated};
        found += find_common_step(samples, 0.0) ? 1 : 0;
      }
      CAPTURE(count, stated, found);
      CHECK(found <= 1);
    }
  }
}

}  // namespace leonav
