// Satellites of one system: orbits, and how well the receiver is told of them.
#pragma once
#include <vector>

#include "core/gnss/satellite.h"
#include "daemon/config/config_reader.h"

namespace leonav::sim {

// Planes of satellites on circular-like orbits, evenly spread.
struct OrbitShell {
  int planes = 1, per_plane = 1;
  double semi_major_axis_m = 0.0;
  double eccentricity = 0.0;
  double inclination = 0.0;      // rad
  double node_span = 0.0;        // rad over which the ascending nodes are spread
  double first_node = 0.0;       // rad, longitude of the first plane's ascending node at the start
  double phase_per_plane = 0.0;  // rad of anomaly from one plane to the next
  double first_anomaly = 0.0;    // rad, argument of latitude of the first satellite
};

struct ConstellationConfig {
  System system = System::kGps;
  bool enabled = true;
  std::vector<OrbitShell> shells;  // satellites are numbered through, from first_number on
  int first_number = 1;
  // Errors of what the receiver is told, 1 sigma.
  double orbit_error_m = 0.02;  // each of along, cross, radial
  double clock_error_m = 0.02;
  double node_interval_s = 900.0;  // of the orbit product
  double clock_interval_s = 30.0;
};

void read_constellation(ConfigReader& group, ConstellationConfig* constellation);

}  // namespace leonav::sim
