#include "core/gnss/orbits/internal/precise_clock.h"

#include <cmath>
#include <limits>
#include <vector>

#include "gps_5_at_noon.h"
#include "support/catch.h"

namespace leonav {
namespace {

using test::kNoon;

constexpr double kOffset = 1e-4, kRate = 1e-11;

std::vector<ClockNode> sampled(int first, int last, double step_s) {
  std::vector<ClockNode> nodes;
  for (int i = first; i <= last; ++i) {
    ClockNode node;
    node.time = kNoon.plus_seconds(i * step_s);
    node.clock_s = kOffset + kRate * i * step_s;
    nodes.push_back(node);
  }
  return nodes;
}

bool lookup(const std::vector<ClockNode>& nodes, double seconds, PreciseClock* clock,
            System system = System::kGps, double max_gap_s = 45.0) {
  return interpolate_clock(nodes.data(), nodes.size(), kNoon.plus_seconds(seconds), max_gap_s,
                           system, clock);
}

}  // namespace

TEST_CASE("between nodes a clock is linear, and surest at the nodes", "[precise_clock]") {
  const auto nodes = sampled(-3, 3, 30.0);
  PreciseClock clock;
  for (double t = -90.0; t <= 90.0; t += 3.7) {
    REQUIRE(lookup(nodes, t, &clock));
    CHECK(std::abs(clock.clock_s - (kOffset + kRate * t)) < 1e-18);
    CHECK(clock.drift == Approx(kRate).epsilon(1e-6));
    CHECK(clock.nearest_s <= 15.0);
  }
  REQUIRE(lookup(nodes, 30.0, &clock));
  CHECK(clock.change_m2 == 0.0);
  // Brownian bridge: q^2 T / 4 in the middle, with the q of GPS clocks.
  REQUIRE(lookup(nodes, 15.0, &clock));
  CHECK(std::sqrt(clock.change_m2) == Approx(3.6e-3 * std::sqrt(7.5)));
  PreciseClock galileo;
  REQUIRE(lookup(nodes, 15.0, &galileo, System::kGalileo));
  CHECK(galileo.change_m2 < 0.1 * clock.change_m2);
}

TEST_CASE("a clock is not extended, nor bridged over a gap or a change", "[precise_clock]") {
  PreciseClock clock;
  CHECK_FALSE(lookup({}, 0.0, &clock));
  CHECK_FALSE(lookup(sampled(0, 0, 30.0), 0.0, &clock));
  auto nodes = sampled(-3, 3, 30.0);
  CHECK(lookup(nodes, -91.4, &clock));  // the signal of an epoch at the first node left before it
  CHECK_FALSE(lookup(nodes, -91.6, &clock));
  CHECK(lookup(nodes, 91.4, &clock));
  CHECK_FALSE(lookup(nodes, 91.6, &clock));
  CHECK_FALSE(lookup(nodes, 1e8, &clock));

  SECTION("a node is missing") {
    nodes.erase(nodes.begin() + 3);
    CHECK_FALSE(lookup(nodes, 0.0, &clock));
    CHECK(lookup(nodes, 0.0, &clock, System::kGps, 60.0));
    CHECK(lookup(nodes, 31.0, &clock));
  }
  SECTION("a change is flagged: the flag stands at the node after it") {
    nodes[3].event = true;
    CHECK_FALSE(lookup(nodes, -15.0, &clock));
    CHECK(lookup(nodes, 15.0, &clock));
    CHECK(lookup(nodes, -45.0, &clock));
  }
  SECTION("no clock") {
    nodes[3].clock_s = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(lookup(nodes, -15.0, &clock));
    CHECK_FALSE(lookup(nodes, 15.0, &clock));
    CHECK(lookup(nodes, -45.0, &clock));
  }
  SECTION("a prediction is less sure by what it does not know") {
    nodes[3].predicted = true;
    REQUIRE(lookup(nodes, 15.0, &clock));
    CHECK(std::sqrt(clock.constant_m2) > 0.3);
    REQUIRE(lookup(nodes, 45.0, &clock));
    CHECK(clock.constant_m2 == 0.0);
  }
}

TEST_CASE("a step of the clock that nothing flags is not bridged", "[precise_clock]") {
  PreciseClock clock;
  const auto stepped = [](double step_s) {
    auto nodes = sampled(-3, 3, 30.0);
    for (std::size_t i = 4; i < nodes.size(); ++i) nodes[i].clock_s += step_s;
    return nodes;
  };
  CHECK(lookup(stepped(0.5e-9), 15.0, &clock));
  for (const double step_s : {-5e-9, 2e-9, 1e-6}) {
    const auto nodes = stepped(step_s);
    CHECK_FALSE(lookup(nodes, 15.0, &clock));
    CHECK(lookup(nodes, -15.0, &clock));  // the pairs on both sides go on
    CHECK(lookup(nodes, 45.0, &clock));
  }
  // The last pair of what is there: its step cannot be told from a new rate, so it does not serve.
  auto ends = stepped(5e-9);
  ends.resize(5);
  CHECK_FALSE(lookup(ends, 15.0, &clock));
  // A new rate: the pair after tells that it goes on.
  auto turned = sampled(-3, 3, 30.0);
  for (std::size_t i = 4; i < turned.size(); ++i) {
    turned[i].clock_s += 5e-9 * static_cast<double>(i - 3);
  }
  CHECK(lookup(turned, 15.0, &clock));
  // Two nodes alone are believed.
  CHECK(lookup({turned[3], turned[4]}, 15.0, &clock));
}

}  // namespace leonav
