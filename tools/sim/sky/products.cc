#include "tools/sim/sky/products.h"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <map>

#include "core/gnss/signal.h"
#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Orbit errors turn over with the revolution: a sine and a cosine of it per axis.
class OrbitError {
 public:
  OrbitError(double sigma_m, double period_s, GaussianGenerator random) : rate_(kTwoPi / period_s) {
    for (int i = 0; i < 2; ++i) amplitude_[i] = sigma_m * random.draw_three();
  }
  // Along, cross, radial.
  Eigen::Vector3d at(double t) const {
    return std::cos(rate_ * t) * amplitude_[0] + std::sin(rate_ * t) * amplitude_[1];
  }

 private:
  double rate_;
  Eigen::Vector3d amplitude_[2];
};

double period_s(const OrbitState& state) {
  constexpr double kGm = 3.986004418e14;
  const double a = 1.0 / (2.0 / state.p_i.norm() - state.v_i.squaredNorm() / kGm);
  return kTwoPi * std::sqrt(a * a * a / kGm);
}

Eigen::Vector3d in_inertial(const OrbitState& state, const Eigen::Vector3d& along_cross_radial) {
  const Eigen::Vector3d radial = state.p_i.normalized();
  const Eigen::Vector3d cross = state.p_i.cross(state.v_i).normalized();
  const Eigen::Vector3d along = cross.cross(radial);
  return along_cross_radial.x() * along + along_cross_radial.y() * cross +
         along_cross_radial.z() * radial;
}

using ByTime = std::map<GpsTime, std::vector<PreciseState>>;

std::vector<OrbitEpoch> in_order(ByTime* by_time) {
  std::vector<OrbitEpoch> epochs;
  for (auto& [time, states] : *by_time) epochs.push_back({time, std::move(states)});
  return epochs;
}

}  // namespace

Products make_products(const Scenario& scenario, const TrueSky& sky) {
  ByTime orbits, clocks;
  const double end = scenario.duration_s + kSkyMargin_s;
  for (const TrueSatellite& satellite : sky.satellites) {
    const ConstellationConfig& c = scenario.constellations[satellite.constellation];
    const OrbitError error(c.orbit_error_m, period_s(satellite.orbit.at(0.0)),
                           random_stream(scenario.seed, "orbit error", place_of(satellite.id)));
    const double bias_m =
        c.clock_error_m *
        random_stream(scenario.seed, "clock error", place_of(satellite.id)).draw();
    const auto node = [&](double t) {
      PreciseState state;
      state.satellite = satellite.id;
      state.time = scenario.start.plus_seconds(t);
      const OrbitState truth = satellite.orbit.at(t);
      state.p_e = to_earth(truth.p_i + in_inertial(truth, error.at(t)), t);
      state.clock_s = satellite.clock.at(t).offset_s + bias_m / kSpeedOfLight;
      return state;
    };
    const double first_orbit = -c.node_interval_s * std::floor(kSkyMargin_s / c.node_interval_s);
    for (double t = first_orbit; t <= end; t += c.node_interval_s) {
      const PreciseState state = node(t);
      orbits[state.time].push_back(state);
    }
    for (double t = -10.0 * c.clock_interval_s; t <= end; t += c.clock_interval_s) {
      PreciseState state = node(t);
      state.p_e.setConstant(kNaN);
      clocks[state.time].push_back(state);
    }
  }
  return {in_order(&orbits), in_order(&clocks)};
}

}  // namespace leonav::sim
