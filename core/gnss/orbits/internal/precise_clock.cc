#include "core/gnss/orbits/internal/precise_clock.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/gnss/signals/signal.h"

namespace leonav {
namespace {

// 1 sigma of a predicted clock: 1.5 ns after removing what all clocks have in common (IGS products,
// ultra-rapid, predicted half: standard deviation).
constexpr double kPredictedClockSigma = 0.45;  // m

double rate(const ClockNode& a, const ClockNode& b) {
  return (b.clock_s - a.clock_s) / seconds_between(b.time, a.time);
}

}  // namespace

// The random walk was measured on 30 s clocks of 2020-06-25 against each other
// (docs/validation/orbits.md): GPS 3.5 (7 at worst, a caesium clock), Galileo's masers 0.34, in
// mm/sqrt(s). BeiDou is taken in between and LEO like GPS, because no such file was at hand.
double clock_walk(System system) {
  switch (system) {
    case System::kGps:
      return 3.6e-3;
    case System::kGalileo:
      return 0.4e-3;
    case System::kBeidou:
      return 2.0e-3;
    case System::kLeo:
      return 3.6e-3;
  }
  return 3.6e-3;
}

bool interpolate_between(const ClockNode& a, const ClockNode& b, GpsTime time, System system,
                         PreciseClock* clock) {
  if (std::isnan(a.clock_s) || std::isnan(b.clock_s) || b.event) return false;
  const double interval = seconds_between(b.time, a.time);
  const double since_a = seconds_between(time, a.time);
  const double until_b = interval - since_a;
  clock->drift = rate(a, b);
  clock->clock_s = a.clock_s + clock->drift * since_a;
  clock->nearest_s = std::min(std::abs(since_a), std::abs(until_b));
  // The error is a random walk tied at both ends (Brownian bridge). Beyond the ends it is free, and
  // the rate is as uncertain as the walk over the interval makes it: the same expression with
  // opposite sign.
  clock->change_m2 = square(clock_walk(system)) * std::abs(since_a * until_b) / interval;
  clock->constant_m2 = a.predicted || b.predicted ? square(kPredictedClockSigma) : 0.0;
  return true;
}

bool is_unflagged_step(const ClockNode* nodes, std::size_t count, std::size_t i, double max_gap_s) {
  const double interval = seconds_between(nodes[i + 1].time, nodes[i].time);
  bool compared = false;
  // Returns whether the nodes `k` and `k` + 1 have the same rate as the pair in question.
  const auto agrees = [&](std::size_t k) {
    const double gap = seconds_between(nodes[k + 1].time, nodes[k].time);
    if (gap > max_gap_s || nodes[k + 1].event) return false;
    const double difference = rate(nodes[k], nodes[k + 1]) - rate(nodes[i], nodes[i + 1]);
    if (std::isnan(difference)) return false;
    compared = true;
    return std::abs(difference) * interval < kClockStep;
  };
  if (i > 0 && agrees(i - 1)) return false;
  if (i + 2 < count && agrees(i + 1)) return false;
  return compared;
}

bool interpolate_clock(const ClockNode* nodes, std::size_t count, GpsTime time, double max_gap_s,
                       System system, PreciseClock* clock) {
  if (count < 2) return false;
  const ClockNode* above = std::upper_bound(
      nodes, nodes + count, time, [](GpsTime t, const ClockNode& node) { return t < node.time; });
  const auto position = static_cast<std::size_t>(above - nodes);
  const std::size_t before = std::min(position > 0 ? position - 1 : 0, count - 2);
  const ClockNode& a = nodes[before];
  const ClockNode& b = nodes[before + 1];
  const double interval = seconds_between(b.time, a.time);
  const double beyond =
      std::max(seconds_between(a.time, time), seconds_between(time, b.time)) / interval;
  if (interval > max_gap_s || beyond > kClockExtrapolation) return false;
  if (is_unflagged_step(nodes, count, before, max_gap_s)) return false;
  return interpolate_between(a, b, time, system, clock);
}

}  // namespace leonav
