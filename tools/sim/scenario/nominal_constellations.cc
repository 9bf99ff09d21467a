#include "tools/sim/scenario/nominal_constellations.h"

#include <numbers>

#include "core/earth/ellipsoid.h"

namespace leonav::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kTurn = 360.0 * kDegree;
constexpr double kGeosynchronous = 42'164'170.0;  // m
constexpr double kBeidouMedium = 27'906'100.0;

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

// Satellite `number` that crosses the equator northwards, or stays, at `longitude_deg`.
OrbitShell geosynchronous(int number, double longitude_deg, double inclination_deg,
                          double anomaly_deg) {
  OrbitShell shell = walker(1, 1, kGeosynchronous, inclination_deg, 0);
  shell.first_anomaly = anomaly_deg * kDegree;
  shell.first_node = (longitude_deg - anomaly_deg) * kDegree;
  shell.first_number = number;
  return shell;
}

// Six planes of five, and a sixth satellite in the last one.
void add_gps(ConstellationConfig* c) {
  c->shells = {walker(6, 5, 26'559'700.0, 55.0, 2)};
  c->shells.push_back(walker(1, 1, 26'559'700.0, 55.0, 0));
  c->shells[1].first_node = 300.0 * kDegree;
  c->shells[1].first_anomaly = (5.0 * 24.0 + 36.0) * kDegree;  // halfway between two of that plane
  for (OrbitShell& shell : c->shells) shell.eccentricity = 0.005;
}

// As at the end of 2020, with the numbers that the real ones have: geostationary BDS-2 C01-C05 and
// BDS-3 C59-C61; inclined BDS-2 C06-C10, C13, C16 and BDS-3 C38-C40; medium BDS-2 C11, C12, C14 and
// BDS-3 C19-C30, C32-C37, C41-C46 (Walker 24/3/1). Longitudes and planes: BDS-SIS-ICD-B1I 3.0, 3.2.
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
  // A plane of eight each; the second one's numbers are in two pieces.
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

// Remote Sensing 2024, 16, 1782, section 3.1: 70 in six polar planes (so not evenly: 12, 12, 12,
// 12, 11, 11), 90 in ten planes of 60 degrees. How the planes are
// phased is not told there: here so that satellites keep farthest apart.
void add_leo(ConstellationConfig* c) {
  for (int plane = 0; plane < 6; ++plane) {
    OrbitShell shell = walker(1, plane < 4 ? 12 : 11, kEarthSemiMajorAxis + 970e3, 90.0, 0);
    shell.first_node = plane * 30.0 * kDegree;
    shell.first_anomaly = plane * 13.0 * kDegree;
    c->shells.push_back(shell);
  }
  c->shells.push_back(walker(10, 9, kEarthSemiMajorAxis + 970e3, 60.0, 2));
  c->shells.back().first_node = 5.0 * kDegree;  // apart from the polar planes'
}

}  // namespace

ConstellationConfig nominal_constellation(System system) {
  ConstellationConfig c;
  c.system = system;
  switch (system) {
    case System::kGps:
      add_gps(&c);
      break;
    case System::kGalileo:
      c.shells = {walker(3, 8, 29'599'800.0, 56.0, 1)};
      c.shells[0].first_node = 25.0 * kDegree;
      c.broadcast.issue_interval_s = 600.0;
      break;
    case System::kBeidou:
      add_beidou(&c);
      c.broadcast.issue_interval_s = 3600.0;
      break;
    case System::kLeo:
      add_leo(&c);
      c.node_interval_s = 30.0;
      c.told = Told::kPrecise;
      c.clock.noise_s_per_sqrt_s = 3e-12;
      c.group_delay_m = 0.0;
      break;
  }
  return c;
}

}  // namespace leonav::sim
