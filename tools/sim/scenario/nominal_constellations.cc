#include "tools/sim/scenario/nominal_constellations.h"

#include <numbers>

#include "core/earth/ellipsoid.h"

namespace leonav::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kTurn = 360.0 * kDegree;
constexpr double kGeosynchronous = 42'164'170.0;  // m

// Walker's i:t/p/f pattern: planes spread over `span`, phased by f * 360 / t degrees.
OrbitShell walker(int planes, int per_plane, double semi_major_axis_m, double inclination_deg,
                  int phasing, double span = kTurn) {
  OrbitShell shell;
  shell.planes = planes;
  shell.per_plane = per_plane;
  shell.semi_major_axis_m = semi_major_axis_m;
  shell.inclination = inclination_deg * kDegree;
  shell.node_span = span;
  shell.phase_per_plane = phasing * kTurn / (planes * per_plane);
  return shell;
}

// One satellite that crosses the equator northwards, or stays, at `longitude_deg`.
OrbitShell geosynchronous(double longitude_deg, double inclination_deg, double anomaly_deg) {
  OrbitShell shell = walker(1, 1, kGeosynchronous, inclination_deg, 0);
  shell.first_anomaly = anomaly_deg * kDegree;
  shell.first_node = (longitude_deg - anomaly_deg) * kDegree;
  return shell;
}

}  // namespace

ConstellationConfig nominal_constellation(System system) {
  ConstellationConfig c;
  c.system = system;
  switch (system) {
    case System::kGps:
      c.shells = {walker(6, 5, 26'559'700.0, 55.0, 2)};
      c.shells[0].eccentricity = 0.005;
      break;
    case System::kGalileo:
      c.shells = {walker(3, 8, 29'599'800.0, 56.0, 1)};
      c.shells[0].first_node = 25.0 * kDegree;
      break;
    case System::kBeidou:
      for (const double longitude : {140.0, 80.0, 110.5, 160.0, 58.75})
        c.shells.push_back(geosynchronous(longitude, 0.0, 0.0));
      for (int i = 0; i < 7; ++i)
        c.shells.push_back(geosynchronous(i < 4 ? 112.0 : 95.0, 55.0, 360.0 * i / 7.0));
      c.shells.push_back(walker(3, 8, 27'906'100.0, 55.0, 1));
      c.shells.back().first_node = 50.0 * kDegree;
      break;
    case System::kLeo:
      // Remote Sensing 2024, 16, 1782, section 3.1: 70 in six polar planes (so not evenly: 12, 12,
      // 12, 12, 11, 11), 90 in ten planes of 60 degrees.
      c.node_interval_s = 30.0;
      for (int plane = 0; plane < 6; ++plane) {
        OrbitShell shell = walker(1, plane < 4 ? 12 : 11, kEarthSemiMajorAxis + 970e3, 90.0, 0);
        shell.first_node = plane * 30.0 * kDegree;
        shell.first_anomaly = plane * 13.0 * kDegree;
        c.shells.push_back(shell);
      }
      c.shells.push_back(walker(10, 9, kEarthSemiMajorAxis + 970e3, 60.0, 5));
      break;
  }
  return c;
}

}  // namespace leonav::sim
