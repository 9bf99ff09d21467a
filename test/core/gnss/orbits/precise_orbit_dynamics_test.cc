// Interpolated orbits against orbits integrated numerically in the Earth's zonal field.
#include <Eigen/Geometry>
#include <cmath>
#include <iostream>
#include <vector>

#include "core/gnss/orbits/precise_orbit.h"
#include "support/catch.h"

namespace leonav {
namespace {

constexpr double kMu = 3.986004418e14, kRadius = 6378136.3, kTurn = 7.2921151467e-5;
constexpr double kJ2 = 1.08263e-3, kJ3 = -2.532e-6, kJ4 = -1.6109e-6;

struct Motion {
  Eigen::Vector3d r, v;  // inertial
};

// Montenbruck and Gill 2000, 3.2: central term and zonal harmonics to degree four.
Eigen::Vector3d acceleration(const Eigen::Vector3d& p) {
  const double r = p.norm(), z = p.z(), s2 = z * z / (r * r);
  const double c2 = -1.5 * kJ2 * kMu * std::pow(kRadius, 2) / std::pow(r, 5);
  const double c3 = -2.5 * kJ3 * kMu * std::pow(kRadius, 3) / std::pow(r, 7);
  const double c4 = 1.875 * kJ4 * kMu * std::pow(kRadius, 4) / std::pow(r, 7);
  const double across = -kMu / std::pow(r, 3) + c2 * (1.0 - 5.0 * s2) +
                        c3 * (3.0 * z - 7.0 * z * s2) + c4 * (1.0 - 14.0 * s2 + 21.0 * s2 * s2);
  Eigen::Vector3d a = across * p;
  a.z() = -kMu / std::pow(r, 3) * z + c2 * z * (3.0 - 5.0 * s2) +
          c3 * (6.0 * z * z - 7.0 * z * z * s2 - 0.6 * r * r) +
          c4 * z * (5.0 - 70.0 / 3.0 * s2 + 21.0 * s2 * s2);
  return a;
}

// Runge-Kutta of fourth order.
Motion step(const Motion& m, double h) {
  const Eigen::Vector3d k1 = acceleration(m.r);
  const Eigen::Vector3d v2 = m.v + 0.5 * h * k1, k2 = acceleration(m.r + 0.5 * h * m.v);
  const Eigen::Vector3d v3 = m.v + 0.5 * h * k2, k3 = acceleration(m.r + 0.5 * h * v2);
  const Eigen::Vector3d v4 = m.v + h * k3, k4 = acceleration(m.r + h * v3);
  return {m.r + h / 6.0 * (m.v + 2.0 * v2 + 2.0 * v3 + v4),
          m.v + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)};
}

// Starts at perigee.
Motion start(double semi_major_axis, double eccentricity, double inclination) {
  const double r = semi_major_axis * (1.0 - eccentricity);
  const double v = std::sqrt(kMu * (1.0 + eccentricity) / r);
  const Eigen::Vector3d along(0.0, std::cos(inclination), std::sin(inclination));
  return {
      Eigen::AngleAxisd(0.7, along.cross(Eigen::Vector3d::UnitX())) * Eigen::Vector3d(r, 0.0, 0.0),
      Eigen::AngleAxisd(0.7, along.cross(Eigen::Vector3d::UnitX())) * (v * along)};
}

struct Truth {
  Eigen::Vector3d p_e, v_e;
};

Truth earth_fixed(const Motion& m, double t) {
  const Eigen::AngleAxisd turn(-kTurn * t, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d p_e = turn * m.r;
  return {p_e, turn * m.v - kTurn * Eigen::Vector3d::UnitZ().cross(p_e)};
}

}  // namespace

TEST_CASE("Interpolated orbits meet integrated ones below a millimetre", "[precise_orbit]") {
  struct Row {
    const char* name;
    double semi_major_axis, eccentricity, inclination, node_s;
    double position_m, velocity_m_s;  // bounds
  };
  constexpr int kNodes = 60, kPerNode = 10;
  const GpsTime first = GpsTime::from_week_and_tow(2200, 345'600.0);
  for (const Row& row :
       {Row{"GPS, 15 min", 26'560e3, 0.02, 0.96, 900.0, 1e-3, 1e-5},
        Row{"Galileo in its eccentric orbit, 15 min", 27'978e3, 0.16, 0.87, 900.0, 1e-3, 1e-5},
        Row{"GPS, 5 min", 26'560e3, 0.02, 0.96, 300.0, 1e-4, 1e-6},
        Row{"LEO at 970 km, 30 s", 7'348e3, 0.001, 1.5, 30.0, 1e-5, 1e-5},
        Row{"LEO at 970 km, 60 s", 7'348e3, 0.001, 1.5, 60.0, 1e-3, 1e-5}}) {
    std::vector<OrbitNode> nodes;
    std::vector<Truth> truth;
    Motion motion = start(row.semi_major_axis, row.eccentricity, row.inclination);
    const double tick = row.node_s / kPerNode;
    const int substeps = static_cast<int>(std::ceil(tick / 3.0));
    for (int i = 0; i <= kNodes * kPerNode; ++i) {
      truth.push_back(earth_fixed(motion, i * tick));
      if (i % kPerNode == 0) {
        OrbitNode node;
        node.time = first.plus_seconds(i * tick);
        node.p_e = truth.back().p_e;
        nodes.push_back(node);
      }
      for (int k = 0; k < substeps; ++k) motion = step(motion, tick / substeps);
    }
    double worst_p = 0.0, worst_v = 0.0, edge = 0.0, edge_sigma = 0.0;
    for (int i = 1; i < kNodes * kPerNode; ++i) {
      SatelliteState state;
      const auto& [p_e, v_e] = truth[static_cast<std::size_t>(i)];
      REQUIRE(precise_state(nodes.data(), nodes.size(), first.plus_seconds(i * tick), 1000.0,
                            System::kGps, nullptr, &state));
      const double error = (state.p_e - p_e).norm();
      // Seven nodes on each side are enough; with fewer the state says how good it is.
      if (i >= 6 * kPerNode && i <= (kNodes - 6) * kPerNode) {
        worst_p = std::max(worst_p, error);
        worst_v = std::max(worst_v, (state.v_e - v_e).norm());
      } else {
        CHECK(error < 3.0 * state.sigma_m);
        if (error > edge) edge = error, edge_sigma = state.sigma_m;
      }
    }
    std::cout << row.name << ": position " << 1e3 * worst_p << " mm, velocity " << 1e3 * worst_v
              << " mm/s; at the ends " << 1e3 * edge << " mm, told " << 1e3 * edge_sigma << " mm\n";
    CHECK(worst_p < row.position_m);
    CHECK(worst_v < row.velocity_m_s);
  }
}

}  // namespace leonav
