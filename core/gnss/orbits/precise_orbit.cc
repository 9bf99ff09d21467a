#include "core/gnss/orbits/precise_orbit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/earth/ellipsoid.h"
#include "core/gnss/signals/signal.h"

namespace leonav {
namespace {

constexpr std::size_t kMinNodes = 5;
// A polynomial whose last term is larger than this does not describe the orbit.
constexpr double kLargestTruncation = 1.0;  // m
// Nodes are rounded to the millimetre: terms below this are noise and do not stop the polynomial.
constexpr double kNodeNoise = 1e-3;  // m
// 1 sigma of the orbit and clock product itself (IGS final: 2-3 cm each, along the line of sight).
constexpr double kProductSigma = 0.03;  // m
// 1 sigma of a predicted orbit (IGS ultra-rapid, predicted half: 5 cm).
constexpr double kPredictedOrbitSigma = 0.05;  // m

// A range of nodes [begin, end) that are linked to each other without a gap: at most
// kPolynomialNodes, as symmetric around `time` as the nodes allow.
struct Range {
  std::size_t begin, end;
};

bool linked(const OrbitNode& a, const OrbitNode& b, double max_gap_s) {
  return seconds_between(b.time, a.time) <= max_gap_s && !b.maneuver;
}

Range window_around(const OrbitNode* nodes, std::size_t count, std::size_t before, GpsTime time,
                    double max_gap_s) {
  Range range{before, before + 1};
  while (range.end - range.begin < kPolynomialNodes) {
    const bool left =
        range.begin > 0 && linked(nodes[range.begin - 1], nodes[range.begin], max_gap_s);
    const bool right =
        range.end < count && linked(nodes[range.end - 1], nodes[range.end], max_gap_s);
    if (!left && !right) break;
    const bool take_right =
        right && (!left || seconds_between(nodes[range.end].time, time) <
                               seconds_between(time, nodes[range.begin - 1].time));
    if (take_right) {
      ++range.end;
    } else {
      --range.begin;
    }
  }
  return range;
}

// Turns an ECEF vector that is valid `seconds` later into the frame that is inertial and equals
// ECEF now.
Eigen::Vector3d inertial(const Eigen::Vector3d& p_e, double seconds) {
  const double angle = kEarthRotationRate * seconds;
  const double s = std::sin(angle), c = std::cos(angle);
  return {c * p_e.x() - s * p_e.y(), s * p_e.x() + c * p_e.y(), p_e.z()};
}

struct Polynomial {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Vector3d derivative = Eigen::Vector3d::Zero();
  double last_term = std::numeric_limits<double>::infinity();
};

// Evaluates the polynomial of Newton's divided differences at zero, with its derivative. The
// nearest nodes enter first, so that the terms shrink while they describe the orbit, and the last
// term shows the cost of leaving out the next one. Near the ends of the nodes the terms grow again,
// because high degrees amplify the nodes' rounding there: the polynomial stops at its smallest
// term. The size of a term is taken as if `t` were at least a quarter interval from the nearest
// node, where every term vanishes.
Polynomial newton_at_zero(const std::array<double, kPolynomialNodes>& t,
                          std::array<Eigen::Vector3d, kPolynomialNodes>& y, std::size_t n) {
  for (std::size_t order = 1; order < n; ++order) {
    for (std::size_t i = n - 1; i >= order; --i) y[i] = (y[i] - y[i - 1]) / (t[i] - t[i - order]);
  }
  const double nearest = std::max(std::abs(t[0]), 0.25 * std::abs(t[1] - t[0]));
  Polynomial sum, best;
  double product = 1.0, product_rate = 0.0;  // of (0 - t[0]) ... (0 - t[i-1])
  double size = 1.0;
  for (std::size_t i = 0; i < n; ++i) {
    sum.value += y[i] * product;
    sum.derivative += y[i] * product_rate;
    sum.last_term = y[i].norm() * size;
    if (i + 1 >= kMinNodes && sum.last_term <= std::max(best.last_term, kNodeNoise)) best = sum;
    product_rate = product - t[i] * product_rate;
    product *= -t[i];
    size *= i == 0 ? nearest : std::abs(t[i]);
  }
  return best;
}

Polynomial orbit_at(const OrbitNode* nodes, Range range, GpsTime time) {
  std::array<std::size_t, kPolynomialNodes> order{};
  const std::size_t n = range.end - range.begin;
  for (std::size_t i = 0; i < n; ++i) order[i] = range.begin + i;
  std::sort(order.begin(), order.begin() + n, [&](std::size_t a, std::size_t b) {
    const double da = std::abs(seconds_between(nodes[a].time, time));
    const double db = std::abs(seconds_between(nodes[b].time, time));
    return da != db ? da < db : a < b;
  });
  std::array<double, kPolynomialNodes> t{};
  std::array<Eigen::Vector3d, kPolynomialNodes> y;
  for (std::size_t i = 0; i < n; ++i) {
    t[i] = seconds_between(nodes[order[i]].time, time);
    y[i] = inertial(nodes[order[i]].p_e, t[i]);
  }
  return newton_at_zero(t, y, n);
}

ClockNode clock_of(const OrbitNode& node) {
  return {node.time, node.clock_s, node.clock_event, node.clock_predicted};
}

}  // namespace

bool precise_state(const OrbitNode* nodes, std::size_t count, GpsTime time, double max_gap_s,
                   System system, const PreciseClock* clock, SatelliteState* state) {
  if (count < kMinNodes || time < nodes[0].time) return false;
  const OrbitNode* above = std::upper_bound(
      nodes, nodes + count, time, [](GpsTime t, const OrbitNode& node) { return t < node.time; });
  // `before` is the interval that contains `time`, or the last one where `time` lies slightly
  // beyond.
  const std::size_t before = std::min(static_cast<std::size_t>(above - nodes) - 1, count - 2);
  const OrbitNode& a = nodes[before];
  const OrbitNode& b = nodes[before + 1];
  const double interval = seconds_between(b.time, a.time);
  const double since_a = seconds_between(time, a.time);
  if (!linked(a, b, max_gap_s) || since_a > interval * (1.0 + kOrbitExtrapolation)) return false;
  PreciseClock own;
  if (clock == nullptr) {
    if (!interpolate_between(clock_of(a), clock_of(b), time, system, &own)) return false;
    clock = &own;
  }

  const Range range = window_around(nodes, count, before, time, max_gap_s);
  if (range.end - range.begin < kMinNodes) return false;
  const Polynomial orbit = orbit_at(nodes, range, time);
  if (!(orbit.last_term < kLargestTruncation)) return false;

  const Eigen::Vector3d& p = orbit.value;
  const Eigen::Vector3d& v_inertial = orbit.derivative;
  state->p_e = p;
  state->v_e =
      v_inertial - Eigen::Vector3d(-kEarthRotationRate * p.y(), kEarthRotationRate * p.x(), 0.0);
  constexpr double kPerC2 = 1.0 / (kSpeedOfLight * kSpeedOfLight);
  state->clock_s = clock->clock_s - 2.0 * p.dot(v_inertial) * kPerC2;
  // d(r.v)/dt = v^2 + r.a, with a of the two-body problem.
  state->clock_drift =
      clock->drift -
      2.0 * (v_inertial.squaredNorm() - kEarthGravitationalConstant / p.norm()) * kPerC2;
  const double change_m2 = orbit.last_term * orbit.last_term + clock->change_m2;
  const double predicted_m = a.orbit_predicted || b.orbit_predicted ? kPredictedOrbitSigma : 0.0;
  state->sigma_change_m = std::sqrt(change_m2);
  state->sigma_m = std::sqrt(kProductSigma * kProductSigma + predicted_m * predicted_m +
                             clock->constant_m2 + change_m2);
  state->age_s = std::min(std::abs(since_a), std::abs(interval - since_a));
  state->source = OrbitSource::kPrecise;
  state->at_antenna = false;
  return true;
}

}  // namespace leonav
