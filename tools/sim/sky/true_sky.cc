#include "tools/sim/sky/true_sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/earth/ellipsoid.h"
#include "core/gnss/signal.h"
#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

// White frequency noise of rubidium clocks and hydrogen masers, and of the oven crystals that low
// satellites steer by GNSS.
ClockErrors clock_errors(System system, GaussianGenerator* random) {
  ClockErrors errors;
  errors.offset_s = 1e-4 * random->draw();
  errors.drift = 1e-11 * random->draw();
  errors.phase_walk_s = system == System::kLeo ? 3e-12 : 1.5e-12;
  return errors;
}

OrbitTable orbit_of(const KeplerElements& elements, System system, double duration_s) {
  const double step = system == System::kLeo ? 30.0 : 120.0;
  const auto before = static_cast<std::size_t>(std::ceil(kSkyMargin_s / step));
  const auto after = static_cast<std::size_t>(std::ceil((duration_s + kSkyMargin_s) / step));
  const OrbitState start = kepler_state(elements);
  std::vector<OrbitState> states = integrate_orbit(start, -step, before + 1);
  std::reverse(states.begin(), states.end());
  const std::vector<OrbitState> later = integrate_orbit(start, step, after + 1);
  states.insert(states.end(), later.begin() + 1, later.end());
  return OrbitTable(-step * static_cast<double>(before), step, states);
}

void add_shell(const Scenario& scenario, std::size_t constellation, const OrbitShell& shell,
               int* number, TrueSky* sky) {
  const System system = scenario.constellations[constellation].system;
  for (int plane = 0; plane < shell.planes; ++plane) {
    for (int slot = 0; slot < shell.per_plane; ++slot, ++*number) {
      const SatelliteId id{system, static_cast<std::uint16_t>(*number)};
      KeplerElements k{};
      k.semi_major_axis_m = shell.semi_major_axis_m;
      k.eccentricity = shell.eccentricity;
      k.inclination = shell.inclination;
      k.node = shell.first_node + shell.node_span * plane / shell.planes;
      k.perigee = shell.eccentricity > 0.0 ? 0.7 * *number : 0.0;
      k.mean_anomaly = std::remainder(shell.first_anomaly + kTwoPi * slot / shell.per_plane +
                                          shell.phase_per_plane * plane - k.perigee,
                                      kTwoPi);
      GaussianGenerator random = random_stream(scenario.seed, "satellite clock", place_of(id));
      const ClockErrors errors = clock_errors(system, &random);
      sky->satellites.push_back(
          {id, constellation, orbit_of(k, system, scenario.duration_s),
           ClockTable(-kSkyMargin_s, scenario.duration_s + kSkyMargin_s, 30.0, errors, random)});
    }
  }
}

}  // namespace

TrueSky build_sky(const Scenario& scenario) {
  TrueSky sky;
  for (std::size_t c = 0; c < scenario.constellations.size(); ++c) {
    if (!scenario.constellations[c].enabled) continue;
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
