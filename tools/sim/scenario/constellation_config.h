// ConstellationConfig configures the satellites of one system: orbits, clocks and the provided
// products.
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/gnss/signals/band_plan.h"
#include "core/gnss/signals/signal.h"
#include "daemon/config/config_reader.h"

namespace leonav::sim {

// Evenly spaced planes of satellites on nearly circular orbits.
struct OrbitShell {
  int planes = 1, per_plane = 1;
  double semi_major_axis_m = 0.0;
  double eccentricity = 0.0;
  double inclination = 0.0;      // rad
  double node_span = 0.0;        // rad over which the ascending nodes are spread
  double first_node = 0.0;       // rad, longitude of the first plane's ascending node at the start
  double phase_per_plane = 0.0;  // rad of anomaly from one plane to the next
  double first_anomaly = 0.0;    // rad, argument of latitude of the first satellite
  int first_number = 0;          // of its satellites; 0: continued from the previous shell
};

// Errors of a product, 1 sigma, m.
struct EphemerisErrors {
  Eigen::Vector3d orbit_m = Eigen::Vector3d::Constant(0.02);  // along, cross, radial
  double clock_m = 0.02;                                      // constant
  double clock_varying_m = 0.0;  // varies with the revolution, as the orbit errors do
  double update_s = 0.0;         // interval at which all are drawn anew; 0: never
};

// True clocks, 1 sigma over the satellites.
struct SatelliteClockConfig {
  double offset_s = 1e-4, drift = 1e-11;
  double noise_s_per_sqrt_s = 0.0;  // white frequency noise
  double drift_walk_per_sqrt_s = 0.0;
};

enum class ProvidedProducts { kPrecise, kBroadcast, kBoth };

// Broadcast messages of a system.
struct BroadcastConfig {
  double issue_interval_s = 7200.0;
  EphemerisErrors errors{{1.0, 0.5, 0.2}, 0.4, 0.0, 0.0};  // drawn anew for every issue
};

// Settings of one system.
struct ConstellationConfig {
  System system = System::kGps;
  bool enabled = true;
  std::vector<OrbitShell> shells;  // satellites are numbered consecutively from first_number
  int first_number = 1;
  // Satellites that stay below the route's horizon for the whole run are left out and get no
  // number: constellations may have more satellites than there are numbers.
  bool only_risen = false;
  std::string file;  // RINEX navigation or SP3: real orbits in place of the shells
  ProvidedProducts provided = ProvidedProducts::kBoth;
  EphemerisErrors precise;
  double node_interval_s = 900.0;  // of the orbit product
  double clock_interval_s = 30.0;
  BroadcastConfig broadcast;
  SatelliteClockConfig clock;
  double group_delay_m = 2.0;  // 1 sigma of TGD, BGD
  // LEO: carriers, and the two signals that are sent; those of the others are fixed.
  BandPlan bands;
  std::array<SignalCode, 2> signals{{{'1', 'C'}, {'2', 'W'}}};
};

void read_constellation(ConfigReader& group, ConstellationConfig* constellation);

}  // namespace leonav::sim
