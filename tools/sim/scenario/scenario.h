// Everything that a scenario file says.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/earth/ellipsoid.h"
#include "core/gnss/gnss_config.h"
#include "core/ins/imu_error_model.h"
#include "core/time/gps_time.h"

namespace leonav::sim {

struct Waypoint {
  Eigen::Vector3d p_n = Eigen::Vector3d::Zero();  // from the origin, tangent plane, m
  double speed_m_s = 13.9;                        // limit from here on
  double stop_s = 0.0;                            // stands here for so long
};

enum class VehicleKind { kCar, kUav };

struct RouteConfig {
  VehicleKind vehicle = VehicleKind::kCar;
  Geodetic origin = {0.6965, 2.0322, 50.0};
  double standing_s = 60.0;         // before it sets off
  std::vector<Waypoint> waypoints;  // empty: a random drive through a city's grid of streets
  double block_m = 250.0;           // of that grid
  double hill_m = 10.0;             // its rise and fall
  double max_acceleration_m_s2 = 1.5, max_braking_m_s2 = 2.0, max_lateral_m_s2 = 2.5;
};

struct ImuConfig {
  bool enabled = true;
  bool ideal = false;  // without any error
  double rate_hz = 200.0;
  ImuErrorModel errors;
};

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

struct NoiseConfig {
  double code_m = 0.3, carrier_m = 0.002, doppler_m_s = 0.03;  // one frequency, at zenith
};

struct ReceiverConfig {
  double interval_s = 1.0;
  Eigen::Vector3d lever_arm_b = {0.4, -0.2, -1.1};
  double elevation_mask = 0.0873;  // rad
  double clock_offset_s = 1e-5, clock_drift = 1e-8;
  double clock_drift_walk = 1e-10;  // per sqrt(s)
  std::array<NoiseConfig, kSystemCount> noise;
  double gnss_latency_s = 0.05;
};

struct AtmosphereConfig {
  double wet_walk_m_per_sqrt_s = 5e-5;
  double wet_offset_m = 0.05;
  double tecu = 20.0;  // vertical, at the origin
  double tec_gradient_per_km = 0.01;
};

struct Scenario {
  std::string name;
  std::uint64_t seed = 1;
  GpsTime start;
  double duration_s = 600.0;
  RouteConfig route;
  ImuConfig imu;
  std::array<ConstellationConfig, kSystemCount> constellations;  // by System
  ReceiverConfig receiver;
  AtmosphereConfig atmosphere;
};

}  // namespace leonav::sim
