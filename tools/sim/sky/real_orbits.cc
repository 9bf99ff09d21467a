#include "tools/sim/sky/real_orbits.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "core/earth/ellipsoid.h"
#include "core/earth/sun_moon.h"
#include "core/gnss/orbits/precise_orbit.h"
#include "core/gnss/signals/signal.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/sp3/sp3_reader.h"
#include "drivers/text/line_reader.h"
#include "tools/sim/sky/true_sky.h"

namespace leonav::sim {
namespace {

constexpr double kStep = 120.0;           // s between the table's nodes
constexpr double kMaxOrbitGap = 1000.0;   // s, between the nodes of the file
constexpr double kMaxTruncation = 0.005;  // m, of a polynomial through nodes
constexpr double kMaxAge = 7200.0;        // s from toe, before the first and after the last one
constexpr double kMaxToeGap = 4.5 * 3600.0;

// Returns the ECEF position `t` s from the start, where the file has one.
using PositionAt = std::function<std::optional<Eigen::Vector3d>(double t)>;

// Inertial positions at multiples of kStep, without a gap, around t = 0.
struct Samples {
  int first = 0;
  std::vector<Eigen::Vector3d> p_i;
};

Samples sample(const PositionAt& position, const OrbitSpan& span) {
  Samples samples;
  std::vector<Eigen::Vector3d> before, after;
  const auto walk = [&](int direction, std::vector<Eigen::Vector3d>* points) {
    for (int i = direction < 0 ? -1 : 0;; i += direction) {
      const double t = i * kStep;
      if (t < span.first_s - 5.0 * kStep || t > span.last_s + 5.0 * kStep) return;
      const auto p_e = position(t);
      if (!p_e) return;
      points->push_back(to_inertial(*p_e, t));
    }
  };
  walk(1, &after);
  if (after.empty()) return samples;
  walk(-1, &before);
  samples.first = -static_cast<int>(before.size());
  samples.p_i.assign(before.rbegin(), before.rend());
  samples.p_i.insert(samples.p_i.end(), after.begin(), after.end());
  return samples;
}

// First and second derivative are central differences of eighth order, whose error is below 1e-12
// of the orbit at these steps.
OrbitTable::Node node_at(const std::vector<Eigen::Vector3d>& p, std::size_t i) {
  constexpr double d1[4] = {4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
  constexpr double d2[4] = {8.0 / 5.0, -1.0 / 5.0, 8.0 / 315.0, -1.0 / 560.0};
  OrbitTable::Node node{p[i], Eigen::Vector3d::Zero(), -205.0 / 72.0 * p[i]};
  for (std::size_t k = 1; k <= 4; ++k) {
    node.v += d1[k - 1] * (p[i + k] - p[i - k]);
    node.a += d2[k - 1] * (p[i + k] + p[i - k]);
  }
  node.v /= kStep;
  node.a /= kStep * kStep;
  return node;
}

// Returns the effect of the Earth's equatorial ellipticity (EGM2008's C22 and S22, not normalized),
// ECEF.
Eigen::Vector3d equator_e(const Eigen::Vector3d& p) {
  constexpr double kC22 = 1.57461533e-6, kS22 = -9.03872789e-7;
  const double r = p.norm(),
               scale = 3.0 * kEarthGravitationalConstant * kGravityRadius * kGravityRadius;
  const double form = kC22 * (p.x() * p.x() - p.y() * p.y()) + 2.0 * kS22 * p.x() * p.y();
  const Eigen::Vector3d slope(2.0 * (kC22 * p.x() + kS22 * p.y()),
                              2.0 * (kS22 * p.x() - kC22 * p.y()), 0.0);
  return scale * (slope / std::pow(r, 5) - 5.0 * form / std::pow(r, 7) * p);
}

// MoreGravity is the acceleration above 1e-7 m/s^2 that the zonal harmonics lack: the equatorial
// ellipticity, and the attraction of Sun and Moon minus that on the Earth's centre. Their positions
// are kept for ten minutes, in which the Moon moves by 0.1 degrees.
class MoreGravity {
 public:
  explicit MoreGravity(GpsTime start) : start_(start) {}

  Eigen::Vector3d operator()(const Eigen::Vector3d& p_i, double t) {
    constexpr double kSun = 1.32712440018e20, kMoon = 4.902800e12;  // m^3/s^2
    const double slot = std::floor(t / 600.0);
    if (!(slot == slot_)) {
      slot_ = slot;
      const SunMoon bodies = sun_moon_positions(start_.plus_seconds(600.0 * slot));
      sun_i_ = to_inertial(bodies.sun_e, 600.0 * slot);
      moon_i_ = to_inertial(bodies.moon_e, 600.0 * slot);
    }
    return kSun * pull(sun_i_, p_i) + kMoon * pull(moon_i_, p_i) +
           to_inertial(equator_e(to_earth(p_i, t)), t);
  }

 private:
  static Eigen::Vector3d pull(const Eigen::Vector3d& body, const Eigen::Vector3d& p) {
    return (body - p) / std::pow((body - p).norm(), 3) - body / std::pow(body.norm(), 3);
  }
  GpsTime start_;
  double slot_ = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector3d sun_i_, moon_i_;
};

// Continues from the node at `t` under the gravity of Earth, Sun and Moon, with `count` more nodes.
std::vector<OrbitTable::Node> beyond(const OrbitTable::Node& last, double t, double step,
                                     std::size_t count, GpsTime start) {
  MoreGravity bodies(start);
  // The remaining acceleration at the node (solar pressure, the elements' own smoothness) is kept.
  const Eigen::Vector3d rest = last.a - gravitation_i(last.p) - bodies(last.p, t);
  const Perturbation more = [&](const Eigen::Vector3d& p_i, double since) -> Eigen::Vector3d {
    return rest + bodies(p_i, t + since);
  };
  std::vector<OrbitTable::Node> nodes;
  double since = 0.0;
  for (const OrbitState& s : integrate_orbit({last.p, last.v}, step, count + 1, more)) {
    nodes.push_back({s.p_i, s.v_i, gravitation_i(s.p_i) + more(s.p_i, since)});
    since += step;
  }
  nodes.erase(nodes.begin());
  return nodes;
}

std::optional<OrbitTable> table_of(const PositionAt& position, const OrbitSpan& span) {
  const Samples samples = sample(position, span);
  if (samples.p_i.size() < 10) return std::nullopt;
  std::vector<OrbitTable::Node> nodes;
  for (std::size_t i = 4; i + 4 < samples.p_i.size(); ++i) nodes.push_back(node_at(samples.p_i, i));
  const double first = (samples.first + 4) * kStep;
  const double last = first + kStep * static_cast<double>(nodes.size() - 1);
  const auto missing = [](double seconds) {
    return static_cast<std::size_t>(std::max(0.0, std::ceil(seconds / kStep)));
  };
  std::vector<OrbitTable::Node> earlier =
      beyond(nodes.front(), first, -kStep, missing(first - span.first_s), span.start);
  const std::vector<OrbitTable::Node> later =
      beyond(nodes.back(), last, kStep, missing(span.last_s - last), span.start);
  const double begin = first - kStep * static_cast<double>(earlier.size());
  std::reverse(earlier.begin(), earlier.end());
  earlier.insert(earlier.end(), nodes.begin(), nodes.end());
  earlier.insert(earlier.end(), later.begin(), later.end());
  return OrbitTable(begin, kStep, std::move(earlier));
}

// Runs from 0 to 1 with its first two derivatives zero at both ends.
double smooth_step(double x) { return x * x * x * (10.0 - x * (15.0 - 6.0 * x)); }

// `issues` holds one issue per toe, in order of toe.
PositionAt broadcast_position(const std::vector<Ephemeris>& issues, GpsTime start) {
  return [&issues, start](double t) -> std::optional<Eigen::Vector3d> {
    const GpsTime time = start.plus_seconds(t);
    const auto after = std::upper_bound(issues.begin(), issues.end(), time,
                                        [](GpsTime a, const Ephemeris& e) { return a < e.toe; });
    const auto at = [time](const Ephemeris& e) { return broadcast_state(e, time).p_e; };
    const auto fresh = [time](const Ephemeris& e) {
      return std::abs(seconds_between(time, e.toe)) <= kMaxAge;
    };
    if (after == issues.begin()) {
      return fresh(*after) ? std::optional(at(*after)) : std::nullopt;
    }
    const Ephemeris& before = *(after - 1);
    if (after == issues.end()) return fresh(before) ? std::optional(at(before)) : std::nullopt;
    const double gap = seconds_between(after->toe, before.toe);
    if (gap > kMaxToeGap) return std::nullopt;
    const double w = smooth_step(seconds_between(time, before.toe) / gap);
    return ((1.0 - w) * at(before) + w * at(*after)).eval();
  };
}

std::vector<RealOrbit> from_navigation(const std::string& path, System system,
                                       const OrbitSpan& span) {
  std::map<SatelliteId, std::map<GpsTime, Ephemeris>> issues;
  for (const Ephemeris& e : read_navigation(path).ephemerides) {
    if (e.satellite.system != system || is_for_corrections_alone(e)) continue;
    auto& of_satellite = issues[e.satellite];
    // Only the first received of Galileo's two messages is used.
    if (of_satellite.empty() || of_satellite.begin()->second.message == e.message) {
      of_satellite.try_emplace(e.toe, e);
    }
  }
  std::vector<RealOrbit> orbits;
  for (const auto& [satellite, by_toe] : issues) {
    std::vector<Ephemeris> list;
    for (const auto& [toe, e] : by_toe) list.push_back(e);
    auto table = table_of(broadcast_position(list, span.start), span);
    if (!table) continue;
    const auto nearest =
        std::min_element(list.begin(), list.end(), [&](const auto& a, const auto& b) {
          return std::abs(seconds_between(a.toe, span.start)) <
                 std::abs(seconds_between(b.toe, span.start));
        });
    const BroadcastDelays delays = {nearest->group_delay_s[0] * kSpeedOfLight,
                                    nearest->group_delay_s[1] * kSpeedOfLight};
    orbits.push_back({satellite, std::move(*table), nearest->health, delays});
  }
  return orbits;
}

std::vector<RealOrbit> from_sp3(const std::string& path, System system, const OrbitSpan& span) {
  std::map<SatelliteId, std::vector<OrbitNode>> nodes;
  for (const Sp3Epoch& epoch : read_sp3(path).epochs) {
    for (const PreciseState& state : epoch.states) {
      if (state.satellite.system != system) continue;
      OrbitNode node;
      node.time = state.time;
      node.p_e = state.p_e;
      node.maneuver = state.maneuver;
      nodes[state.satellite].push_back(node);
    }
  }
  std::vector<RealOrbit> orbits;
  for (const auto& entry : nodes) {
    const auto& list = entry.second;
    const PositionAt position = [&](double t) -> std::optional<Eigen::Vector3d> {
      SatelliteState state;
      const PreciseClock any_clock;
      const bool there = precise_state(list.data(), list.size(), span.start.plus_seconds(t),
                                       kMaxOrbitGap, system, &any_clock, &state);
      // Towards the file's ends polynomials lose centimetres, which derivatives would magnify.
      const bool good = there && state.sigma_change_m < kMaxTruncation;
      return good ? std::optional(state.p_e) : std::nullopt;
    };
    if (auto table = table_of(position, span)) {
      orbits.push_back({entry.first, std::move(*table), 0, std::nullopt});
    }
  }
  return orbits;
}

bool is_sp3(const std::string& path) {
  LineReader lines(path);
  std::string_view line;
  return lines.next(line) && line.starts_with("#");
}

}  // namespace

std::vector<RealOrbit> load_real_orbits(const std::string& path, System system,
                                        const OrbitSpan& span) {
  std::vector<RealOrbit> orbits =
      is_sp3(path) ? from_sp3(path, system, span) : from_navigation(path, system, span);
  if (!orbits.empty()) return orbits;
  throw FileError(path, 0,
                  "has no orbit of a " + std::string(to_string(system)) +
                      " satellite at the scenario's start (GPS week " +
                      std::to_string(span.start.week()) + ", second " +
                      std::to_string(static_cast<long>(span.start.tow_s())) +
                      "); set start_gps_week and start_gps_tow_s to a time within it");
}

}  // namespace leonav::sim
