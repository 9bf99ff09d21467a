// The learned correlation of errors against processes of known correlation, and its inflation
// against the variance of means.
#include "core/filter/error_model/error_correlation.h"

#include <cmath>
#include <random>
#include <vector>

#include "support/catch.h"
#include "support/start_time.h"

using namespace leonav;

namespace {

ErrorCorrelation::Priors priors(double share, double time_s) {
  ErrorCorrelation::Priors priors;
  for (auto& of_observable : priors) of_observable.fill({share, time_s});
  return priors;
}

// White noise plus a Gauss-Markov process, of variance 1 together.
class Process {
 public:
  Process(double share, double time_s, std::mt19937_64* random)
      : share_(share), r_(std::exp(-1.0 / time_s)), random_(random), state_(normal_(*random)) {}
  double next() {
    state_ = r_ * state_ + std::sqrt(1.0 - r_ * r_) * normal_(*random_);
    return std::sqrt(share_) * state_ + std::sqrt(1.0 - share_) * normal_(*random_);
  }

 private:
  double share_, r_;
  std::mt19937_64* random_;
  std::normal_distribution<double> normal_;
  double state_;
};

// Fifteen satellites once a second, with errors that are `times` as large as their sigma.
CorrelationModel learned(double share, double time_s, double seconds, ErrorCorrelation* correlation,
                         double times = 1.0) {
  std::mt19937_64 random(7);
  std::vector<Process> processes;
  for (int i = 0; i < 15; ++i) processes.emplace_back(share, time_s, &random);
  ErrorClass of;
  for (int t = 0; t < seconds; ++t) {
    const GpsTime now = test::kAnyTime.plus_seconds(t);
    for (std::size_t i = 0; i < processes.size(); ++i) {
      const SatelliteId satellite{System::kGps, static_cast<std::uint16_t>(i + 1)};
      correlation->add({satellite, {'1', 'C'}, of, times * processes[i].next()}, now);
    }
    correlation->end_epoch(1.0);
  }
  return correlation->model(of);
}

}  // namespace

TEST_CASE("the inflation of variance is that of a long mean") {
  for (const CorrelationModel model : {CorrelationModel{1.0, 10.0}, {0.3, 25.0}, {0.0, 5.0}}) {
    for (const double dt : {0.25, 1.0, 7.0}) {
      double sum = 1.0;
      for (int n = 1; n < 20000; ++n) sum += 2.0 * model.share * std::exp(-n * dt / model.time_s);
      CHECK(variance_inflation(model, dt) == Approx(sum).epsilon(1e-6));
    }
  }
  CHECK(variance_inflation({1.0, 0.0}, 1.0) == 1.0);
  CHECK(variance_inflation({1.0, 10.0}, 0.0) == 1.0);
}

TEST_CASE("without a sample the correlation is the configured one") {
  ErrorCorrelation correlation(priors(0.4, 12.0));
  CHECK(correlation.model({}).share == 0.4);
  CHECK(correlation.model({}).time_s == 12.0);
}

TEST_CASE("the correlation comes to that of the errors where these last longer than configured") {
  struct Case {
    double share, time_s;
  };
  for (const Case of : {Case{0.9, 12.0}, {0.6, 24.0}, {1.0, 3.0}}) {
    for (const double configured_s : {0.0, 0.5}) {
      ErrorCorrelation correlation(priors(0.9, configured_s));
      const CorrelationModel model = learned(of.share, of.time_s, 600.0, &correlation);
      CAPTURE(of.share, of.time_s, configured_s, model.share, model.time_s);
      const double expected = variance_inflation({of.share, of.time_s}, 1.0);
      const double found = variance_inflation(model, 1.0);
      CHECK(found < 1.6 * expected + 0.5);
      CHECK(found > 0.55 * expected - 0.5);
    }
  }
}

TEST_CASE("errors that last shorter than configured leave the configured correlation") {
  ErrorCorrelation correlation(priors(0.9, 60.0));
  const CorrelationModel model = learned(0.9, 5.0, 600.0, &correlation);
  CHECK(model.share == 0.9);
  CHECK(model.time_s == 60.0);
}

// A mean of errors of half the sigma has a quarter of the variance that its sigmas say, and what is
// correlated in them costs it a quarter as much.
TEST_CASE("errors smaller than their sigma have a smaller correlated share, larger ones do not") {
  const auto share = [](double times) {
    ErrorCorrelation correlation(priors(0.0, 10.0));
    return learned(0.9, 24.0, 600.0, &correlation, times).share;
  };
  const double as_configured = share(1.0);
  CHECK(as_configured == Approx(0.9).margin(0.15));
  CHECK(share(0.5) == Approx(0.25 * as_configured).margin(0.08));
  CHECK(share(0.25) < share(0.5));
  CHECK(share(2.0) == Approx(as_configured).margin(0.1));
}

TEST_CASE("errors of a standing vehicle are not taken for those of a moving one") {
  ErrorCorrelation correlation(priors(0.0, 10.0));
  ErrorClass standing;
  standing.motion = 1;
  for (int t = 0; t < 120; ++t) {
    for (std::uint16_t i = 0; i < 15; ++i)
      correlation.add({{System::kGps, i}, {'1', 'C'}, standing, i % 2 == 0 ? 1.0 : -1.0},
                      test::kAnyTime.plus_seconds(t));
    correlation.end_epoch(1.0);
  }
  CHECK(correlation.model(standing).share > 0.8);
  CHECK(correlation.model({}).share == 0.0);
}

TEST_CASE("more signals than the table holds are left out and nothing breaks") {
  ErrorCorrelation correlation(priors(0.5, 10.0));
  for (int t = 0; t < 3; ++t) {
    for (std::uint16_t i = 0; i < 700; ++i)
      correlation.add({{System::kLeo, i}, {'1', 'C'}, {}, 0.5}, test::kAnyTime.plus_seconds(t));
    correlation.end_epoch(1.0);
  }
  CHECK(std::isfinite(correlation.model({}).share));
}
