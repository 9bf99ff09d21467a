#include "core/integrity/risk.h"

#include <cmath>
#include <random>

#include "support/catch.h"

using namespace leonav;

TEST_CASE("the risk of an hour is shared among its independent samples") {
  CHECK(samples_per_hour(30.0) == 120.0);
  CHECK(risk_per_sample(1.2e-5, 30.0) == Approx(1e-7));
  // Errors that stay for longer than an hour still take one sample.
  CHECK(samples_per_hour(7200.0) == 1.0);
  CHECK(risk_per_sample(1e-5, 7200.0) == 1e-5);
}

TEST_CASE("in simulated hours of independent samples the risk of an hour is kept") {
  // Samples that each fail with the risk of one sample; an hour fails if any of them does.
  constexpr double kRisk = 0.05, kCorrelation_s = 60.0;
  const double sample_risk = risk_per_sample(kRisk, kCorrelation_s);
  std::mt19937_64 generator(7);
  std::bernoulli_distribution fails(sample_risk);
  constexpr int kHours = 40'000;
  int failed_hours = 0;
  for (int hour = 0; hour < kHours; ++hour) {
    bool failed = false;
    for (int sample = 0; sample < 60; ++sample) failed = fails(generator) || failed;
    failed_hours += failed ? 1 : 0;
  }
  // 1 - (1 - r / 60)^60 = 0.04879; three sigma of the count are 0.0033.
  const double share = static_cast<double>(failed_hours) / kHours;
  CHECK(share == Approx(0.04879).margin(0.0033));
  CHECK(share < kRisk);
}

TEST_CASE("a fault is present for its exposure, or for one sample at least") {
  // 1e-4 per hour and 36 s: a hundredth of an hour.
  CHECK(fault_probability(1e-4, 36.0, 10.0) == Approx(1e-6));
  CHECK(fault_probability(1e-4, 1.0, 36.0) == Approx(1e-6));
  CHECK(fault_probability(1e-4, 0.0, 36.0) == Approx(1e-6));
  CHECK(fault_probability(1e6, 3600.0, 10.0) == 1.0);
}
