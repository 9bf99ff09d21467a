#include "tools/sim/sky/true_sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/earth/ellipsoid.h"
#include "core/gnss/measurement/look_angles.h"
#include "core/gnss/signals/signal.h"
#include "tools/sim/scenario/random_streams.h"
#include "tools/sim/sky/broadcast.h"
#include "tools/sim/sky/products.h"
#include "tools/sim/sky/real_orbits.h"

namespace leonav::sim {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kClockStep = 30.0;  // s

ClockTable clock_of(const Scenario& scenario, const ConstellationConfig& c, SatelliteId id) {
  GaussianGenerator random = random_stream(scenario.seed, "satellite clock", table_index_of(id));
  ClockErrors errors;
  errors.offset_s = c.clock.offset_s * random.draw();
  errors.drift = c.clock.drift * random.draw();
  errors.phase_walk_s = c.clock.noise_s_per_sqrt_s;
  errors.drift_walk = c.clock.drift_walk_per_sqrt_s;
  const double margin = kClockStep * std::ceil(sky_margin_s(c) / kClockStep);
  return ClockTable(-margin, scenario.duration_s + margin, kClockStep, errors, random);
}

BroadcastDelays delays_of(const Scenario& scenario, const ConstellationConfig& c, SatelliteId id) {
  GaussianGenerator random = random_stream(scenario.seed, "group delay", table_index_of(id));
  BroadcastDelays delays;
  for (double& delay : delays) delay = c.group_delay_m * random.draw();
  if (c.system == System::kGps) delays[1] = 0.0;  // LNAV has only one
  return delays;
}

OrbitTable orbit_of(const KeplerElements& elements, System system, double margin_s,
                    double duration_s) {
  const double step = system == System::kLeo ? 30.0 : 120.0;
  const auto before = static_cast<std::size_t>(std::ceil(margin_s / step));
  const auto after = static_cast<std::size_t>(std::ceil((duration_s + margin_s) / step));
  const OrbitState start = kepler_state(elements);
  std::vector<OrbitState> states = integrate_orbit(start, -step, before + 1);
  std::reverse(states.begin(), states.end());
  const std::vector<OrbitState> later = integrate_orbit(start, step, after + 1);
  states.insert(states.end(), later.begin() + 1, later.end());
  return OrbitTable(-step * static_cast<double>(before), step, states);
}

// The horizon is that of the route's origin, with a margin for the length of the route: 100 km are
// 0.9 degrees.
bool rises(const Scenario& scenario, const OrbitTable& orbit) {
  constexpr double kMargin = 2.0 * std::numbers::pi / 180.0, kLookStep = 20.0;
  const Eigen::Vector3d p_e = to_ecef(scenario.route.origin);
  for (double t = 0.0; t < scenario.duration_s + kLookStep; t += kLookStep) {
    if (look_angles(to_earth(orbit.at(t).p_i, t), p_e).elevation > -kMargin) return true;
  }
  return false;
}

void check_number(const SatelliteId& id) {
  if (is_valid(id)) return;
  throw std::runtime_error("more satellites of " + std::string(to_string(id.system)) +
                           " than there are numbers (" +
                           std::to_string(kHighestNumber[index_of(id.system)]) +
                           ") rise during the run; make it shorter");
}

void add_shell(const Scenario& scenario, std::size_t constellation, const OrbitShell& shell,
               int* number, TrueSky* sky) {
  const ConstellationConfig& c = scenario.constellations[constellation];
  if (shell.first_number != 0) *number = shell.first_number;
  for (int plane = 0; plane < shell.planes; ++plane) {
    for (int slot = 0; slot < shell.per_plane; ++slot) {
      KeplerElements k{};
      k.semi_major_axis_m = shell.semi_major_axis_m;
      k.eccentricity = shell.eccentricity;
      k.inclination = shell.inclination;
      k.node = shell.first_node + shell.node_span * plane / shell.planes;
      k.perigee = shell.eccentricity > 0.0 ? 0.7 * *number : 0.0;
      k.mean_anomaly = std::remainder(shell.first_anomaly + kTwoPi * slot / shell.per_plane +
                                          shell.phase_per_plane * plane - k.perigee,
                                      kTwoPi);
      OrbitTable orbit = orbit_of(k, c.system, sky_margin_s(c), scenario.duration_s);
      if (c.only_risen && !rises(scenario, orbit)) continue;
      const SatelliteId id{c.system, static_cast<std::uint16_t>((*number)++)};
      check_number(id);
      sky->satellites.push_back({id, constellation, std::move(orbit), clock_of(scenario, c, id),
                                 delays_of(scenario, c, id), 0});
    }
  }
}

void add_real(const Scenario& scenario, std::size_t constellation, TrueSky* sky) {
  const ConstellationConfig& c = scenario.constellations[constellation];
  const OrbitSpan span{scenario.start, -sky_margin_s(c), scenario.duration_s + sky_margin_s(c)};
  for (RealOrbit& real : load_real_orbits(c.file, c.system, span)) {
    const BroadcastDelays delays =
        real.group_delay_m ? *real.group_delay_m : delays_of(scenario, c, real.satellite);
    sky->satellites.push_back({real.satellite, constellation, std::move(real.orbit),
                               clock_of(scenario, c, real.satellite), delays, real.health});
  }
}

}  // namespace

double sky_margin_s(const ConstellationConfig& c) {
  // The margin is at least that of a low satellite under a GPS name (export.h).
  const double products =
      std::max(1900.0, (kOrbitNodesAhead + 2) * c.node_interval_s + 12.0 * c.clock_interval_s);
  return c.provided == ProvidedProducts::kPrecise ? products
                                                  : std::max(products, kBroadcastMargin_s);
}

TrueSky build_sky(const Scenario& scenario) {
  TrueSky sky;
  for (std::size_t c = 0; c < scenario.constellations.size(); ++c) {
    if (!scenario.constellations[c].enabled) continue;
    if (!scenario.constellations[c].file.empty()) {
      add_real(scenario, c, &sky);
      continue;
    }
    int number = scenario.constellations[c].first_number;
    for (const OrbitShell& shell : scenario.constellations[c].shells) {
      add_shell(scenario, c, shell, &number, &sky);
    }
  }
  std::stable_sort(sky.satellites.begin(), sky.satellites.end(),
                   [](const auto& a, const auto& b) { return a.id < b.id; });
  return sky;
}

double clock_s(const TrueSatellite& satellite, double t) {
  const OrbitState state = satellite.orbit.at(t);
  return satellite.clock.at(t).offset_s -
         2.0 * state.p_i.dot(state.v_i) / (kSpeedOfLight * kSpeedOfLight);
}

Eigen::Vector3d to_earth(const Eigen::Vector3d& p_i, double t) {
  const double c = std::cos(kEarthRotationRate * t), s = std::sin(kEarthRotationRate * t);
  return {c * p_i.x() + s * p_i.y(), c * p_i.y() - s * p_i.x(), p_i.z()};
}

Eigen::Vector3d to_inertial(const Eigen::Vector3d& p_e, double t) { return to_earth(p_e, -t); }

}  // namespace leonav::sim
