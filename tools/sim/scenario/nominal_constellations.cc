#include "tools/sim/scenario/nominal_constellations.h"

#include <cmath>
#include <vector>

#include "core/base/angle.h"
#include "core/earth/ellipsoid.h"

namespace leonav::sim {
namespace {

constexpr double kTurn = 360.0 * kDegree;
constexpr double kGeosynchronous = 42'164'170.0;  // m
constexpr double kBeidouMedium = 27'906'100.0;

// Returns Walker's i:t/p/f pattern: planes spread over `span`, phased by f * 360 / t degrees.
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

// Returns satellite `number`, which crosses the equator northwards, or stays, at `longitude_deg`.
OrbitShell geosynchronous(int number, double longitude_deg, double inclination_deg,
                          double anomaly_deg) {
  OrbitShell shell = walker(1, 1, kGeosynchronous, inclination_deg, 0);
  shell.first_anomaly = anomaly_deg * kDegree;
  shell.first_node = (longitude_deg - anomaly_deg) * kDegree;
  shell.first_number = number;
  return shell;
}

// The satellites are in the 24 slots of the GPS SPS Performance Standard (5th edition, 2020, table
// 3.2-1), of which B1, D2 and F2 are expanded to two each (table 3.2-2), and four more where the
// gaps in the planes are widest: 31 as flown. Walker's patterns of 30 have a worse geometry at
// mid-latitudes.
void add_gps(ConstellationConfig* c) {
  static const std::vector<std::vector<double>> arguments_of_latitude_deg = {
      {268.126, 161.786, 11.676, 41.806, 101.8, 215.0},
      {94.916, 66.356, 173.336, 309.976, 204.376},
      {111.876, 11.796, 339.666, 241.556, 176.7},
      {135.226, 282.676, 257.976, 35.156, 167.356},
      {197.046, 302.596, 66.066, 333.686, 131.6},
      {238.886, 0.456, 334.016, 105.206, 135.346}};
  double node_deg = 272.847;
  for (const std::vector<double>& plane : arguments_of_latitude_deg) {
    for (const double latitude_deg : plane) {
      OrbitShell shell = walker(1, 1, 26'559'700.0, 55.0, 0);
      shell.eccentricity = 0.005;
      shell.first_node = std::remainder(node_deg, 360.0) * kDegree;
      shell.first_anomaly = latitude_deg * kDegree;
      c->shells.push_back(shell);
    }
    node_deg += 60.0;
  }
}

// The constellation is that at the end of 2020, with the real numbers: geostationary BDS-2 C01-C05
// and BDS-3 C59-C61; inclined BDS-2 C06-C10, C13, C16 and BDS-3 C38-C40; medium BDS-2 C11, C12, C14
// and BDS-3 C19-C30, C32-C37, C41-C46 (Walker 24/3/1). Longitudes and planes: BDS-SIS-ICD-B1I 3.0,
// 3.2.
void add_beidou(ConstellationConfig* c) {
  int number = 1;
  for (const double longitude : {140.0, 80.0, 110.5, 160.0, 58.75})
    c->shells.push_back(geosynchronous(number++, longitude, 0.0, 0.0));
  number = 59;
  for (const double longitude : {140.0, 80.0, 110.5})
    c->shells.push_back(geosynchronous(number++, longitude + 0.3, 0.0, 0.0));
  int place = 0;
  for (const int inclined : {6, 7, 8, 9, 10, 13, 16, 38, 39, 40}) {
    c->shells.push_back(
        geosynchronous(inclined, place % 2 == 0 ? 118.0 : 95.0, 55.0, 36.0 * place));
    ++place;
  }
  place = 0;
  for (const int medium : {11, 12, 14}) {
    OrbitShell shell = walker(1, 1, kBeidouMedium, 55.0, 0);
    shell.first_number = medium;
    shell.first_node = 50.0 * kDegree;
    shell.first_anomaly = (22.5 + 45.0 * place++) * kDegree;
    c->shells.push_back(shell);
  }
  // Each plane has eight; the numbers of the second one are in two pieces.
  const auto piece = [c](int first, int plane, int slot, int count) {
    OrbitShell shell = walker(1, 1, kBeidouMedium, 55.0, 0);
    shell.first_node = (50.0 + 120.0 * plane) * kDegree;
    for (int i = 0; i < count; ++i) {
      shell.first_number = first + i;
      shell.first_anomaly = (15.0 * plane + 45.0 * (slot + i)) * kDegree;
      c->shells.push_back(shell);
    }
  };
  piece(19, 0, 0, 8);
  piece(27, 1, 0, 4);
  piece(32, 1, 4, 4);
  piece(36, 2, 0, 2);
  piece(41, 2, 2, 6);
}

// The source is Remote Sensing 2024, 16, 1782, section 3.1: 70 in six polar planes (hence unevenly:
// 12, 12, 12, 12, 11, 11), 90 in ten planes of 60 degrees. The paper does not give the phasing of
// the planes; here it keeps the satellites farthest apart.
void add_leo(ConstellationConfig* c) {
  for (int plane = 0; plane < 6; ++plane) {
    OrbitShell shell = walker(1, plane < 4 ? 12 : 11, kEarthSemiMajorAxis + 970e3, 90.0, 0);
    shell.first_node = plane * 30.0 * kDegree;
    shell.first_anomaly = plane * 13.0 * kDegree;
    c->shells.push_back(shell);
  }
  c->shells.push_back(walker(10, 9, kEarthSemiMajorAxis + 970e3, 60.0, 2));
  c->shells.back().first_node = 5.0 * kDegree;  // distinct from the polar planes
}

}  // namespace

// The clock noise of GPS and Galileo is that of their products (docs/validation/orbits.md), the
// others' is assumed.
ConstellationConfig nominal_constellation(System system) {
  ConstellationConfig c;
  c.system = system;
  switch (system) {
    case System::kGps:
      add_gps(&c);
      c.clock.noise_s_per_sqrt_s = 1.2e-11;
      break;
    case System::kGalileo:
      c.shells = {walker(3, 8, 29'599'800.0, 56.0, 1)};
      c.shells[0].first_node = 25.0 * kDegree;
      c.broadcast.issue_interval_s = 600.0;
      c.clock.noise_s_per_sqrt_s = 1.2e-12;
      break;
    case System::kBeidou:
      add_beidou(&c);
      c.clock.noise_s_per_sqrt_s = 6.7e-12;
      c.broadcast.issue_interval_s = 3600.0;
      break;
    case System::kLeo:
      add_leo(&c);
      c.node_interval_s = 30.0;
      c.provided = ProvidedProducts::kPrecise;
      c.broadcast.issue_interval_s = 600.0;
      c.clock.noise_s_per_sqrt_s = 3e-12;
      c.group_delay_m = 0.0;
      break;
  }
  return c;
}

}  // namespace leonav::sim
