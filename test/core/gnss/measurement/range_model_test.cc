#include "core/gnss/measurement/range_model.h"

#include <Eigen/Geometry>

#include "core/earth/ellipsoid.h"
#include "core/gnss/signals/signal.h"
#include "support/catch.h"
#include "support/sky/simulated_sky.h"

using namespace leonav;

namespace {

struct NamedSatellite {
  const char* name;
  SatelliteInView satellite;
};

SatelliteInView satellite(const Eigen::Vector3d& p_e, const Eigen::Vector3d& v_e) {
  SatelliteInView view;
  view.p_e = p_e;
  view.v_e = v_e;
  return view;
}

const Eigen::Vector3d kAntenna = to_ecef({0.7, 0.2, 100.0});
const Eigen::Vector3d kAntennaVelocity(12.0, -25.0, 3.0);

std::vector<NamedSatellite> cases() {
  return {{"GPS", satellite({15'600e3, 7'540e3, 20'140e3}, {-1500.0, 2400.0, 900.0})},
          {"LEO", satellite({5'700e3, 1'900e3, 4'400e3}, {-4100.0, -3100.0, 5600.0})}};
}

}  // namespace

TEST_CASE("range Jacobian equals numerical differentiation") {
  for (const NamedSatellite& c : cases()) {
    INFO(c.name);
    const RangePrediction range = predict_range(c.satellite, kAntenna);
    CHECK(range.range_m == Approx((c.satellite.p_e - kAntenna).norm()).epsilon(1e-15));
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d h = 10.0 * Eigen::Vector3d::Unit(i);
      const double numeric = (predict_range(c.satellite, kAntenna + h).range_m -
                              predict_range(c.satellite, kAntenna - h).range_m) /
                             20.0;
      CHECK(range.d_range_d_p(i) == Approx(numeric).margin(1e-9));
    }
  }
}

TEST_CASE("range rate Jacobians equal numerical differentiation, at LEO speed too") {
  for (const NamedSatellite& c : cases()) {
    INFO(c.name);
    const RangeRatePrediction rate = predict_range_rate(c.satellite, kAntenna, kAntennaVelocity);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d dp = 100.0 * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d dv = 10.0 * Eigen::Vector3d::Unit(i);
      const auto at = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& v) {
        return predict_range_rate(c.satellite, p, v).range_rate_m_s;
      };
      const double by_p =
          (at(kAntenna + dp, kAntennaVelocity) - at(kAntenna - dp, kAntennaVelocity)) / 200.0;
      const double by_v =
          (at(kAntenna, kAntennaVelocity + dv) - at(kAntenna, kAntennaVelocity - dv)) / 20.0;
      CHECK(rate.d_rate_d_p(i) == Approx(by_p).epsilon(1e-6).margin(1e-11));
      CHECK(rate.d_rate_d_v(i) == Approx(by_v).margin(1e-10));
    }
  }
}

// Oracle: the light-time equation solved in inertial space at five instants and differentiated
// numerically, for a satellite on a Kepler orbit.
TEST_CASE("range rate equals the derivative of the light-time range") {
  test::SimulatedReceiver receiver;
  receiver.v_e = {20.0, -150.0, 80.0};
  receiver.atmosphere = false;
  double worst = 0.0, largest_light_time_term = 0.0;
  int compared = 0;
  for (const test::Walker& walker : {test::gps_walker(), test::leo_walker()}) {
    test::SimulatedSky sky;
    sky.add(walker);
    for (Ephemeris e : sky.ephemerides) {
      e.af0 = 0.0;
      e.af1 = 0.0;
      if (test::simulated_elevation(receiver, e, 0.0) < 0.1) continue;
      const auto range = [&](double t) {
        const SatelliteState state = broadcast_state(e, test::kSkyEpoch.plus_seconds(t));
        // The pseudorange holds the relativistic clock term, to be taken out again.
        return test::simulated_pseudorange(sky, receiver, e, t, 1575.42e6) +
               kSpeedOfLight * state.clock_s;
      };
      constexpr double h = 0.05;
      const double numeric =
          (8.0 * (range(h) - range(-h)) - (range(2 * h) - range(-2 * h))) / (12.0 * h);

      double flight = range(0.0) / kSpeedOfLight;
      for (int i = 0; i < 3; ++i) {
        const SatelliteState s = broadcast_state(e, test::kSkyEpoch.plus_seconds(-flight));
        flight = (test::inertial(s.p_e, -flight) - receiver.p_e).norm() / kSpeedOfLight;
      }
      const SatelliteState s = broadcast_state(e, test::kSkyEpoch.plus_seconds(-flight));
      const SatelliteInView view =
          satellite(test::inertial(s.p_e, -flight), test::inertial(s.v_e, -flight));
      const double predicted = predict_range_rate(view, receiver.p_e, receiver.v_e).range_rate_m_s;
      const Eigen::Vector3d u = (view.p_e - receiver.p_e).normalized();
      largest_light_time_term =
          std::max(largest_light_time_term, std::abs(predicted - u.dot(view.v_e - receiver.v_e)));
      worst = std::max(worst, std::abs(predicted - numeric));
      ++compared;
    }
  }
  CAPTURE(worst, largest_light_time_term, compared);
  CHECK(compared > 15);
  CHECK(largest_light_time_term > 0.05);  // so the test would notice if the term were missing
  CHECK(worst < 1e-3);
}

TEST_CASE("the line of sight turns as two directions a second apart say") {
  const auto turned = [](const SatelliteInView& s) {
    const Eigen::Vector3d now = s.p_e - kAntenna, later = s.p_e + s.v_e - kAntenna;
    return std::atan2(now.cross(later).norm(), now.dot(later));
  };
  for (const NamedSatellite& c : cases()) {
    INFO(c.name);
    CHECK(line_of_sight_rate(c.satellite, kAntenna) == Approx(turned(c.satellite)).epsilon(5e-3));
  }
  CHECK(line_of_sight_rate(satellite({42'164e3, 0.0, 0.0}, {0.0, 0.0, 0.0}), kAntenna) == 0.0);
}

TEST_CASE("errors that hang on the direction persist as it does") {
  CHECK(correlation_time_ratio(0.0) == 1.0);
  CHECK(correlation_time_ratio(1.6e-4) == 1.0);
  CHECK(correlation_time_ratio(8e-3) == Approx(0.02));
}
