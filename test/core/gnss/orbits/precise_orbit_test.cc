#include "core/gnss/orbits/precise_orbit.h"

#include <limits>
#include <vector>

#include "broadcast_oracle.h"
#include "support/catch.h"

namespace leonav {
namespace {

// The true orbit of these tests: Kepler elements, which broadcast_state evaluates exactly.
Ephemeris kepler(double semi_major_axis, double eccentricity) {
  Ephemeris e;
  e.satellite = {System::kGps, 1};
  e.toe = e.toc = GpsTime::from_week_and_tow(2200, 345600.0);
  e.sqrt_a = std::sqrt(semi_major_axis);
  e.eccentricity = eccentricity;
  e.i0 = 0.96;
  e.omega0 = 1.0;
  e.omega = 0.5;
  return e;
}

std::vector<OrbitNode> sampled(const Ephemeris& e, int first, int last, double step) {
  std::vector<OrbitNode> nodes;
  for (int i = first; i <= last; ++i) {
    const GpsTime t = e.toe.plus_seconds(i * step);
    OrbitNode node;
    node.time = t;
    node.p_e = broadcast_state(e, t).p_e;
    node.clock_s = 1e-4 + 1e-12 * i * step;
    nodes.push_back(node);
  }
  return nodes;
}

bool lookup(const std::vector<OrbitNode>& nodes, GpsTime time, SatelliteState* state,
            double max_gap_s = 1000.0) {
  return precise_state(nodes.data(), nodes.size(), time, max_gap_s, System::kGps, nullptr, state);
}

}  // namespace

TEST_CASE("Between nodes the orbit is met to the millimetre, its velocity and clock too",
          "[precise_orbit]") {
  struct Row {
    double semi_major_axis, eccentricity, step_s, position_m, velocity_m_s;
  };
  for (const Row& row : {Row{2.656e7, 0.01, 900.0, 1e-3, 1e-5},    // GPS, SP3 every 15 minutes
                         Row{2.656e7, 0.01, 300.0, 1e-4, 1e-6},    // every 5 minutes
                         Row{4.2164e7, 0.005, 900.0, 1e-3, 1e-5},  // IGSO
                         Row{7.5e6, 0.001, 60.0, 1e-4, 1e-6},      // LEO
                         Row{7.5e6, 0.001, 300.0, 0.05, 2e-3}}) {
    Ephemeris e = kepler(row.semi_major_axis, row.eccentricity);
    const auto nodes = sampled(e, -6, 6, row.step_s);
    INFO("step " << row.step_s << " s, a " << row.semi_major_axis);
    for (const double share : {0.0, 0.1, 0.5, 0.77, 1.0, 1.5}) {
      const GpsTime t = e.toe.plus_seconds(share * row.step_s);
      const SatelliteState truth = broadcast_state(e, t);
      SatelliteState state;
      REQUIRE(lookup(nodes, t, &state));
      CHECK((state.p_e - truth.p_e).norm() < row.position_m);
      CHECK((state.v_e - truth.v_e).norm() < row.velocity_m_s);
      // SP3 clocks come without the periodic relativity; broadcast_state adds it to zeros here.
      const double clock = 1e-4 + 1e-12 * share * row.step_s + truth.clock_s;
      CHECK(std::abs(state.clock_s - clock) < 1e-13);
      CHECK(std::abs(state.clock_drift - (1e-12 + truth.clock_drift)) < 2e-15);
      CHECK((state.p_e - truth.p_e).norm() < 3.0 * state.sigma_m);
      CHECK(state.source == OrbitSource::kPrecise);
    }
  }
}

TEST_CASE("Each node left out is met by the others", "[precise_orbit]") {
  const Ephemeris e = kepler(2.656e7, 0.02);
  const auto nodes = sampled(e, -8, 8, 300.0);
  for (std::size_t leave = 5; leave < 12; ++leave) {
    auto others = nodes;
    others.erase(others.begin() + static_cast<long>(leave));
    SatelliteState state;
    REQUIRE(lookup(others, nodes[leave].time, &state));
    CHECK((state.p_e - nodes[leave].p_e).norm() < 1e-4);
  }
}

TEST_CASE("At the edges the state gets worse and says so; beyond there is none",
          "[precise_orbit]") {
  const Ephemeris e = kepler(2.656e7, 0.01);
  const auto nodes = sampled(e, 0, 12, 900.0);
  SatelliteState state;
  const auto at = [&](double seconds) {
    return lookup(nodes, e.toe.plus_seconds(seconds), &state);
  };
  const auto error = [&](double seconds) {
    return (state.p_e - broadcast_state(e, e.toe.plus_seconds(seconds)).p_e).norm();
  };
  CHECK(at(0.0));
  CHECK(error(0.0) < 1e-6);
  CHECK(at(450.0));
  CHECK(error(450.0) < 3.0 * state.sigma_m);
  CHECK(error(450.0) < 0.05);
  CHECK_FALSE(at(-0.001));
  CHECK(at(12 * 900.0));
  CHECK(at(12 * 900.0 + 40.0));
  CHECK(error(12 * 900.0 + 40.0) < 3.0 * state.sigma_m);
  CHECK_FALSE(at(12 * 900.0 + 50.0));
  CHECK_FALSE(at(1e7));
}

TEST_CASE("Gaps are not bridged and clocks are not made up", "[precise_orbit]") {
  const Ephemeris e = kepler(2.656e7, 0.01);
  auto nodes = sampled(e, -8, 12, 300.0);
  SatelliteState state;
  const GpsTime t = e.toe.plus_seconds(100.0);

  SECTION("a gap around the instant") {
    nodes.erase(nodes.begin() + 7, nodes.begin() + 11);  // -300 ... 600 s
    CHECK_FALSE(lookup(nodes, t, &state));
    CHECK(lookup(nodes, t, &state, 2000.0));
  }
  SECTION("a gap nearby leaves too few nodes on this side") {
    const std::vector<OrbitNode> island(nodes.begin() + 8, nodes.begin() + 11);  // 0, 300, 600 s
    auto separated = sampled(e, -40, -30, 300.0);
    separated.insert(separated.end(), island.begin(), island.end());
    CHECK_FALSE(lookup(separated, t, &state));
  }
  SECTION("no clock on either side") {
    nodes[9].clock_s = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(lookup(nodes, t, &state));
    CHECK(lookup(nodes, e.toe.plus_seconds(-100.0), &state));
  }
  SECTION("nodes that are no orbit") {
    nodes[8].p_e.x() += 1e5;
    CHECK_FALSE(lookup(nodes, t, &state));
  }
  SECTION("few nodes") {
    nodes.resize(4);
    CHECK_FALSE(lookup(nodes, nodes[1].time.plus_seconds(1.0), &state));
    nodes.clear();
    CHECK_FALSE(lookup(nodes, t, &state));
  }
}

}  // namespace leonav
