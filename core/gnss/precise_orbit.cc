#include "core/gnss/precise_orbit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/earth/ellipsoid.h"
#include "core/gnss/signal.h"

namespace leonav {
namespace {

constexpr std::size_t kPolynomialNodes = 10;
constexpr std::size_t kFewestNodes = 5;
// A polynomial whose last term is larger than this does not describe the orbit.
constexpr double kLargestTruncation = 1.0;  // m
// Orbit and clock product themselves (IGS final: 2-3 cm each, along the line of sight).
constexpr double kProductSigma = 0.03;  // m
// What a clock does between two nodes a second apart; grows with the square root of the interval
// as a random walk does (0.05 m over 15 minutes, 0.01 m over 30 s).
constexpr double kClockWalk = 1.7e-3;  // m/sqrt(s)

// Nodes [begin, end) that are linked to `anchor` without a gap, at most kPolynomialNodes of them,
// as symmetric around `time` as they come.
struct Range {
  std::size_t begin, end;
};

bool linked(const OrbitNode& a, const OrbitNode& b, double max_gap_s) {
  return seconds_between(b.time, a.time) <= max_gap_s;
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
    // Take the nearer of the two.
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

// Turns an ECEF vector of `seconds` later into the frame that is inertial and equals ECEF now.
Eigen::Vector3d inertial(const Eigen::Vector3d& p_e, double seconds) {
  const double angle = kEarthRotationRate * seconds;
  const double s = std::sin(angle), c = std::cos(angle);
  return {c * p_e.x() - s * p_e.y(), s * p_e.x() + c * p_e.y(), p_e.z()};
}

struct Polynomial {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Vector3d derivative = Eigen::Vector3d::Zero();
  double last_term = 0.0;
};

// Newton's divided differences, evaluated at zero with the derivative. Nodes enter nearest first,
// so that the last term is the smallest and tells what leaving out the next one costs.
Polynomial newton_at_zero(std::array<double, kPolynomialNodes>& t,
                          std::array<Eigen::Vector3d, kPolynomialNodes>& y, std::size_t n) {
  for (std::size_t order = 1; order < n; ++order) {
    for (std::size_t i = n - 1; i >= order; --i) y[i] = (y[i] - y[i - 1]) / (t[i] - t[i - order]);
  }
  Polynomial p;
  double product = 1.0, product_rate = 0.0;  // of (0 - t[0]) ... (0 - t[i-1])
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d term = y[i] * product;
    p.value += term;
    p.derivative += y[i] * product_rate;
    p.last_term = term.norm();
    product_rate = product - t[i] * product_rate;
    product *= -t[i];
  }
  return p;
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

}  // namespace

bool precise_state(const OrbitNode* nodes, std::size_t count, GpsTime time, double max_gap_s,
                   SatelliteState* state) {
  if (count < kFewestNodes || time < nodes[0].time) return false;
  const OrbitNode* above = std::upper_bound(
      nodes, nodes + count, time, [](GpsTime t, const OrbitNode& node) { return t < node.time; });
  // The interval that `time` lies in, or the last one for the little that may lie beyond.
  const std::size_t before = std::min(static_cast<std::size_t>(above - nodes) - 1, count - 2);
  const OrbitNode& a = nodes[before];
  const OrbitNode& b = nodes[before + 1];
  const double interval = seconds_between(b.time, a.time);
  const double since_a = seconds_between(time, a.time);
  if (interval > max_gap_s || since_a > interval * (1.0 + kOrbitExtrapolation)) return false;
  if (std::isnan(a.clock_s) || std::isnan(b.clock_s)) return false;

  const Range range = window_around(nodes, count, before, time, max_gap_s);
  if (range.end - range.begin < kFewestNodes) return false;
  const Polynomial orbit = orbit_at(nodes, range, time);
  if (!(orbit.last_term < kLargestTruncation)) return false;

  const Eigen::Vector3d& p = orbit.value;
  const Eigen::Vector3d& v_inertial = orbit.derivative;
  state->p_e = p;
  state->v_e =
      v_inertial - Eigen::Vector3d(-kEarthRotationRate * p.y(), kEarthRotationRate * p.x(), 0.0);
  constexpr double kPerC2 = 1.0 / (kSpeedOfLight * kSpeedOfLight);
  const double slope = (b.clock_s - a.clock_s) / interval;
  state->clock_s = a.clock_s + slope * since_a - 2.0 * p.dot(v_inertial) * kPerC2;
  // d(r.v)/dt = v^2 + r.a, with a of the two-body problem.
  state->clock_drift =
      slope - 2.0 * (v_inertial.squaredNorm() - kEarthGravitationalConstant / p.norm()) * kPerC2;
  const double nearest = std::min(std::abs(since_a), std::abs(interval - since_a));
  state->sigma_m = std::sqrt(kProductSigma * kProductSigma + orbit.last_term * orbit.last_term +
                             kClockWalk * kClockWalk * nearest);
  state->age_s = nearest;
  state->source = OrbitSource::kPrecise;
  return true;
}

}  // namespace leonav
