// The learned scale of sigmas against errors of known size.
#include "core/filter/error_model/sigma_scale.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "error_model/code_class.h"
#include "support/catch.h"

using namespace leonav;

namespace {

// Ten codes of one class a second, `times` as large as their sigma as scaled.
void drive(SigmaScale* scale, const ErrorClass& of, double times, double seconds,
           std::mt19937_64* random, double gross_share = 0.0) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  for (int t = 0; t < seconds; ++t) {
    for (int i = 0; i < 10; ++i) {
      const double gross = uniform(*random) < gross_share ? 30.0 : 1.0;
      const double z = gross * times * normal(*random) / scale->scale(of);
      scale->add({of, z * z, 1.0});
    }
    scale->end_epoch(1.0);
  }
}

}  // namespace

TEST_CASE("the scale of sigmas comes to what the errors are, but not below one") {
  for (const double times : {0.5, 1.0, 3.0, 6.0}) {
    std::mt19937_64 random(1);
    SigmaScale scale;
    drive(&scale, test::code_class(1), times, 300.0, &random);
    CHECK(scale.scale(test::code_class(1)) == Approx(std::max(times, 1.0)).epsilon(0.15));
  }
}

TEST_CASE(
    "what an earlier run has learned holds until errors are seen, and a minute later no more") {
  SigmaScale scale;
  scale.start(Observable::kCode, 8.0, 1.0);
  CHECK(scale.scale(test::code_class(1)) == Approx(8.0));
  CHECK(scale.mean_scale(Observable::kDoppler) == SigmaScale().mean_scale(Observable::kDoppler));
  std::mt19937_64 random(1);
  drive(&scale, test::code_class(1), 1.0, 60.0, &random);
  CHECK(scale.scale(test::code_class(1)) < 1.5);
  scale.start(Observable::kCode, 1e6, 1.0);
  CHECK(scale.mean_scale(Observable::kCode) < 31.0);
  // What is older counts less, against what is expected without it.
  const double unknown = SigmaScale().mean_scale(Observable::kCode);
  scale.start(Observable::kCode, 8.0, 0.5);
  CHECK(scale.mean_scale(Observable::kCode) == Approx(std::sqrt(8.0 * unknown)));
  scale.start(Observable::kCode, 8.0, 0.0);
  CHECK(scale.mean_scale(Observable::kCode) == unknown);
}

TEST_CASE("a street is entered within half a minute, and left within a minute") {
  std::mt19937_64 random(2);
  SigmaScale scale;
  drive(&scale, test::code_class(1), 1.0, 300.0, &random);
  drive(&scale, test::code_class(1), 5.0, 30.0, &random);
  CHECK(scale.scale(test::code_class(1)) > 3.5);
  drive(&scale, test::code_class(1), 1.0, 60.0, &random);
  CHECK(scale.scale(test::code_class(1)) < 1.6);
}

TEST_CASE("one gross error in twenty does not double the scale") {
  std::mt19937_64 random(3);
  SigmaScale scale;
  drive(&scale, test::code_class(1), 1.0, 300.0, &random, 0.05);
  CHECK(scale.scale(test::code_class(1)) < 1.4);
}

TEST_CASE("a class that is not seen has the scale that all share") {
  std::mt19937_64 random(4);
  SigmaScale scale;
  for (int i = 0; i < 300; ++i) {
    drive(&scale, test::code_class(0), 6.0, 1.0, &random);
    drive(&scale, test::code_class(3), 2.0, 1.0, &random);
  }
  CHECK(scale.scale(test::code_class(0)) > 2.0 * scale.scale(test::code_class(3)));
  const double unseen = scale.scale(test::code_class(2));
  CHECK(unseen > scale.scale(test::code_class(3)));
  CHECK(unseen < scale.scale(test::code_class(0)));
}

TEST_CASE("innovations that the prediction's variance explains leave the scale as it is") {
  SigmaScale scale;
  const double before = scale.scale(test::code_class(1));
  for (int t = 0; t < 100; ++t) {
    for (int i = 0; i < 10; ++i) scale.add({test::code_class(1), 4.0, 0.0});
    scale.end_epoch(1.0);
  }
  CHECK(scale.scale(test::code_class(1)) == Approx(before));
}

TEST_CASE(
    "the first epoch says at once how large errors are, low satellites apart from high ones") {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  SigmaScale scale;
  std::vector<SigmaScale::Sample> samples;
  for (int i = 0; i < 60; ++i) {
    const bool low = i % 2 == 0;
    double error = (low ? 6.0 : 1.5) * normal(random);
    if (i % 20 == 0) error += 80.0;  // reflected
    samples.push_back({test::code_class(low ? 0 : 3), error * error, 1.0});
  }
  REQUIRE(scale.fit_first(Observable::kCode, samples));
  CHECK(scale.scale(test::code_class(0)) == Approx(6.0).epsilon(0.4));
  CHECK(scale.scale(test::code_class(3)) == Approx(1.5).epsilon(0.4));
}

TEST_CASE("seven errors are too few to begin with") {
  SigmaScale scale;
  const double before = scale.scale(test::code_class(0));
  const std::vector<SigmaScale::Sample> samples(7, {test::code_class(0), 100.0, 1.0});
  CHECK_FALSE(scale.fit_first(Observable::kCode, samples));
  CHECK(scale.scale(test::code_class(0)) == before);
}

TEST_CASE("after an hour of small errors a street is entered as quickly") {
  std::mt19937_64 random(6);
  for (const bool first : {false, true}) {
    SigmaScale scale;
    if (first) {
      const std::vector<SigmaScale::Sample> small(30, {test::code_class(1), 0.01, 1.0});
      REQUIRE(scale.fit_first(Observable::kCode, small));
    }
    drive(&scale, test::code_class(1), 0.2, 3600.0, &random);
    drive(&scale, test::code_class(1), 5.0, 30.0, &random);
    CAPTURE(first);
    CHECK(scale.scale(test::code_class(1)) > 3.5);
  }
}

TEST_CASE("the summary tells what each property makes of the scale") {
  std::mt19937_64 random(3);
  SigmaScale scale;
  ErrorClass low = test::code_class(0), high = test::code_class(3);
  for (int t = 0; t < 300; ++t) {
    std::normal_distribution<double> normal;
    for (int i = 0; i < 10; ++i)
      for (const auto& [of, times] : {std::pair(low, 6.0), std::pair(high, 2.0)}) {
        const double z = times * normal(random) / scale.scale(of);
        scale.add({of, z * z, 1.0});
      }
    scale.end_epoch(1.0);
  }
  ObservableErrors summary;
  scale.summarize(Observable::kCode, &summary);
  CHECK(summary.all.sigma_factor == scale.mean_scale(Observable::kCode));
  const auto of = [&](std::string_view name) {
    const auto* found = std::find(kLearnedClassNames.begin(), kLearnedClassNames.end(), name);
    return summary.classes[static_cast<std::size_t>(found - kLearnedClassNames.begin())]
        .sigma_factor;
  };
  CHECK(of("below 20 deg") > 1.5 * of("above 50 deg"));
  CHECK(of("35 to 50 deg") == summary.all.sigma_factor);  // never seen
  CHECK(of("Galileo") == summary.all.sigma_factor);
}
