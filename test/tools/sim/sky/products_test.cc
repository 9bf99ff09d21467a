// What precise products tell of simulated satellites.
#include "tools/sim/sky/products.h"

#include <cmath>

#include "support/catch.h"
#include "tools/sim/scenario/scenario_yaml.h"
#include "tools/sim/sky/ephemeris_error.h"

using namespace leonav;
using namespace leonav::sim;

namespace {

// Along, cross, radial error of one state; clock error in m.
Eigen::Vector4d error_of(const PreciseState& told, const Scenario& scenario, const TrueSky& sky) {
  const auto truth = std::find_if(sky.satellites.begin(), sky.satellites.end(),
                                  [&](const auto& s) { return s.id == told.satellite; });
  const double t = seconds_between(told.time, scenario.start);
  const OrbitState state = truth->orbit.at(t);
  const Eigen::Vector3d miss = to_inertial(told.p_e, t) - state.p_i;
  Eigen::Vector4d error;
  for (int axis = 0; axis < 3; ++axis) {
    error[axis] = miss.dot(in_inertial(state, Eigen::Vector3d::Unit(axis)));
  }
  error[3] = kSpeedOfLight * (told.clock_s - truth->clock.at(t).offset_s);
  return error;
}

// Root mean square over all states of a system.
Eigen::Vector4d rms(const Scenario& scenario, System system) {
  const TrueSky sky = build_sky(scenario);
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  int count = 0;
  for (const OrbitEpoch& epoch : make_products(scenario, sky).orbits) {
    for (const PreciseState& state : epoch.states) {
      if (state.satellite.system != system) continue;
      sum += error_of(state, scenario, sky).cwiseAbs2();
      ++count;
    }
  }
  REQUIRE(count > 100);
  return (sum / count).cwiseSqrt();
}

}  // namespace

TEST_CASE("Errors of products are set along, across, radially and for clocks, system by system") {
  const Scenario scenario = load_scenario_text(
      "duration_s: 600\nsatellites:\n  gps: {along_error_m: 0.3, cross_error_m: 0.2, "
      "radial_error_m: 0.1, clock_error_m: 0.4}\n  leo: {orbit_error_m: 0, clock_error_m: 0}\n"
      "  galileo: {told: broadcast}\n",
      "scenario.yaml");
  const Eigen::Vector4d gps = rms(scenario, System::kGps);
  const Eigen::Vector4d expected(0.3, 0.2, 0.1, 0.4);
  for (int i = 0; i < 4; ++i) CHECK(gps[i] == Approx(expected[i]).epsilon(0.35));
  CHECK(rms(scenario, System::kLeo).maxCoeff() < 1e-6);
  const TrueSky sky = build_sky(scenario);
  for (const OrbitEpoch& epoch : make_products(scenario, sky).orbits) {
    for (const PreciseState& state : epoch.states) {
      REQUIRE(state.satellite.system != System::kGalileo);
    }
  }
}

TEST_CASE("Errors vary slowly, and step where a product is updated") {
  const EphemerisErrors sigma{Eigen::Vector3d::Constant(0.1), 0.1, 0.05, 3600.0};
  const EphemerisError error(sigma, {System::kGps, 3}, 43'000.0, 1, "product");
  const auto change = [&](double t) {
    return std::abs(error.orbit_m(t + 1.0).x() - error.orbit_m(t).x()) +
           std::abs(error.clock_m(t + 1.0) - error.clock_m(t));
  };
  for (const double t : {-7000.0, -3.0, 10.0, 3500.0, 3600.0, 7000.0}) CHECK(change(t) < 1e-3);
  for (const double t : {-3601.0, -1.0, 3599.0, 7199.0}) CHECK(change(t) > 0.01);
  const EphemerisError never({sigma.orbit_m, 0.1, 0.05, 0.0}, {System::kGps, 3}, 43'000.0, 1,
                             "product");
  for (double t = 0.0; t < 7300.0; t += 1.0) {
    CHECK(std::abs(never.clock_m(t + 1.0) - never.clock_m(t)) < 1e-4);
  }
}

TEST_CASE("Satellite clocks without noise are straight lines") {
  const Scenario scenario = load_scenario_text(
      "satellites:\n  leo: {clock: {noise_s_per_sqrt_s: 0}}\n  gps: {enabled: true}\n",
      "scenario.yaml");
  double worst_leo = 0.0, worst_gps = 0.0;
  for (const TrueSatellite& s : build_sky(scenario).satellites) {
    const double bend = std::abs(s.clock.at(0.0).offset_s - 2.0 * s.clock.at(150.0).offset_s +
                                 s.clock.at(300.0).offset_s);
    if (s.id.system == System::kLeo) worst_leo = std::max(worst_leo, bend);
    if (s.id.system == System::kGps) worst_gps = std::max(worst_gps, bend);
  }
  CHECK(worst_leo < 1e-18);
  CHECK(worst_gps > 1e-12);
}
