// The processes that correlated street errors are made of, held against their definitions.
#include <cmath>
#include <vector>

#include "support/catch.h"
#include "tools/sim/street/gauss_markov.h"
#include "tools/sim/street/on_off.h"
#include "tools/sim/street/street_slips.h"

using namespace leonav;
using sim::OnOff;

TEST_CASE("A Gauss-Markov process has unit variance and forgets exponentially", "[sim][street]") {
  constexpr int kSteps = 400'000;
  constexpr double kStep = 0.05;  // half a node: nodes and middles
  sim::GaussMarkov process(17);
  std::vector<double> x;
  for (int i = 0; i < kSteps; ++i) x.push_back(process.at(kStep * i).value);
  double sum = 0.0, even = 0.0, odd = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    sum += x[i];
    (i % 2 == 0 ? even : odd) += x[i] * x[i];
  }
  CHECK(std::abs(sum / kSteps) < 0.05);
  CHECK(even / (kSteps / 2) == Approx(1.0).epsilon(0.05));
  CHECK(odd / (kSteps / 2) == Approx(1.0).epsilon(0.05));
  for (const double lag : {0.1, 0.5, 1.0, 2.0}) {
    const int steps = static_cast<int>(std::lround(lag / kStep));
    double product = 0.0;
    for (int i = 0; i + steps < kSteps; ++i) product += x[i] * x[i + steps];
    INFO("lag " << lag);
    CHECK(product / (kSteps - steps) == Approx(std::exp(-lag)).margin(0.03));
  }
}

TEST_CASE("The slope of a Gauss-Markov process is its derivative", "[sim][street]") {
  constexpr double kStep = 1e-5;
  sim::GaussMarkov process(5);
  double worst = 0.0, largest = 0.0;
  for (double argument = 0.003; argument < 20.0; argument += 0.0137) {
    const double before = process.at(argument - kStep).value;
    const double slope = process.at(argument).slope;
    const double after = process.at(argument + kStep).value;
    worst = std::max(worst, std::abs(slope - (after - before) / (2.0 * kStep)));
    largest = std::max(largest, std::abs(slope));
  }
  CHECK(largest > 3.0);
  CHECK(worst < 5e-3);  // the curvature jumps at nodes
}

TEST_CASE("A process is on for its share of the time, for its mean duration", "[sim][street]") {
  OnOff process(3, 0.15, 6.0);
  double on_s = 0.0, time_s = 0.0;
  unsigned episodes = 0, last = process.is_on() ? 1 : 0;
  for (; time_s < 400'000.0; time_s += 0.5) {
    process.advance(time_s);
    on_s += process.is_on() ? 0.5 : 0.0;
    if (process.is_on() && process.episode() != last) {
      ++episodes;
      last = process.episode();
    }
  }
  CHECK(on_s / time_s == Approx(0.15).epsilon(0.05));
  // Of episodes shorter than the step 8 % are missed.
  CHECK(on_s / episodes == Approx(6.0).epsilon(0.1));
}

TEST_CASE("A process without a share is never on", "[sim][street]") {
  for (std::uint64_t key = 0; key < 100; ++key) {
    OnOff never(key, 0.0, 6.0);
    never.advance(1e6);
    CHECK_FALSE(never.is_on());
  }
}

TEST_CASE("Slips come as often as asked for, in thirds, half of them told", "[sim][street]") {
  const sim::StreetSlipsConfig config;
  sim::StreetSlips slips(config, 11);
  int events = 0, single = 0, pair = 0, random = 0, told = 0;
  constexpr double kEnd_s = 3e6;
  for (double t = 1.0; t < kEnd_s; t += 1.0) {
    const auto now = slips.until(t);
    const double first = now[0].cycles, second = now[1].cycles;
    if (first == 0.0 && second == 0.0) continue;
    ++events;
    told += now[0].told || now[1].told ? 1 : 0;
    CHECK(first == std::round(first));
    if (std::abs(first) + std::abs(second) == 1.0) {
      ++single;
    } else if (first == second && std::abs(first) == 1.0) {
      ++pair;
    } else {
      ++random;
      CHECK(std::max(std::abs(first), std::abs(second)) <= 2.0 * config.max_cycles);
    }
  }
  CHECK(events == Approx(kEnd_s / 300.0).epsilon(0.05));
  // Of the random ones a fifteenth is of one cycle on one signal alone, a few of the same on both.
  CHECK(single == Approx(events * (1.0 + 2.0 / 30.0) / 3.0).epsilon(0.05));
  CHECK(pair == Approx(events / 3.0).epsilon(0.05));
  CHECK(random == Approx(events * (1.0 - 2.0 / 30.0) / 3.0).epsilon(0.05));
  CHECK(told == Approx(0.5 * events).epsilon(0.05));
}
