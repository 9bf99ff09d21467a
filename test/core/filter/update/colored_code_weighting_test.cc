// The weights of codes with correlated errors, against the best linear estimate from all of them at
// once.
#include "core/filter/update/colored_code_weighting.h"

#include <Eigen/Core>
#include <cmath>

#include "support/catch.h"
#include "support/dense/dense_algebra.h"
#include "support/start_time.h"

using namespace leonav;

namespace {

Measurement code_of(double noise, double correlated) {
  Measurement code;
  code.code = {'1', 'C'};
  code.sigma = std::hypot(noise, correlated);
  code.correlated_sigma = correlated;
  return code;
}

// Information that `count` codes give about a constant, by the covariance of all their errors.
double best_information(double noise, double correlated, double time_s, double dt, int count) {
  Eigen::MatrixXd R = noise * noise * Eigen::MatrixXd::Identity(count, count);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j)
      R(i, j) += correlated * correlated * std::exp(-dt * std::abs(i - j) / time_s);
  }
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(count);
  return ones.dot(dense::solve_symmetric(R, ones));
}

}  // namespace

TEST_CASE("what codes with correlated errors weigh adds up to the best estimate's information") {
  struct Case {
    double noise, correlated, time_s, dt;
  };
  for (const Case& c : {Case{0.5, 2.0, 3600.0, 30.0}, Case{4.0, 0.7, 3600.0, 1.0},
                        Case{1.0, 1.0, 900.0, 30.0}, Case{3.0, 0.02, 3600.0, 1.0}}) {
    ColoredCodeWeighting schedule;
    const Measurement code = code_of(c.noise, c.correlated);
    double information = 0.0;
    for (int k = 0; k < 200; ++k) {
      int place = -1;
      const double variance = schedule.weigh(
          code, {System::kGps, 7}, {.orbit_issue = 3, .correlation_time_s = c.time_s},
          c.noise * c.noise, test::kAnyTime.plus_seconds(c.dt * k), &place);
      REQUIRE(variance > 0.0);
      schedule.accept(place);
      information += 1.0 / variance;
      if (k % 20 != 0 && k > 3) continue;
      const double best = best_information(c.noise, c.correlated, c.time_s, c.dt, k + 1);
      CHECK(information == Approx(best).epsilon(1e-5));
    }
  }
}

TEST_CASE("a code that was not used has told nothing, and another orbit errs anew") {
  ColoredCodeWeighting schedule;
  const Measurement code = code_of(0.3, 2.0);
  const double plain = 0.09 + 4.0;
  const SatelliteId satellite{System::kGps, 7};
  int place = -1;
  ColoredCodeWeighting::CodeErrorModel error_model{.orbit_issue = 3, .correlation_time_s = 3600.0};
  const auto weigh = [&](double t) {
    return schedule.weigh(code, satellite, error_model, 0.09, test::kAnyTime.plus_seconds(t),
                          &place);
  };
  CHECK(weigh(0.0) == Approx(plain));
  CHECK(weigh(30.0) == Approx(plain));  // the first was not accepted
  schedule.accept(place);
  CHECK(weigh(60.0) > 10.0 * plain);
  schedule.accept(place);
  CHECK(weigh(90.0) > 10.0 * plain);
  error_model.orbit_issue = 4;
  CHECK(weigh(90.0) < 3.0 * plain);
  schedule.clear();
  CHECK(weigh(120.0) == Approx(plain));
}
