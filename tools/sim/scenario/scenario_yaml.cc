#include "tools/sim/scenario/scenario_yaml.h"

#include <numbers>

#include "daemon/config/config_file.h"
#include "daemon/config/config_groups.h"
#include "tools/sim/scenario/nominal_constellations.h"

namespace leonav::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr Bounds kMetres = {0.0, 1e6}, kAngle = {-360.0, 360.0}, kSigma = {0.0, 1e3};

void read_waypoint(ConfigReader& group, RouteConfig* route) {
  Waypoint w;
  constexpr Bounds kPlace = {-1e5, 1e5};
  double up_m = 0.0;
  group.number("north_m", kPlace, &w.p_n.x());
  group.number("east_m", kPlace, &w.p_n.y());
  group.number("up_m", {-1e3, 1e4}, &up_m);
  w.p_n.z() = -up_m;
  group.number("speed_m_s", {0.5, 300.0}, &w.speed_m_s);
  group.number("stop_s", {0.0, 1e5}, &w.stop_s);
  route->waypoints.push_back(w);
}

void read_route(ConfigReader& group, RouteConfig* route) {
  group.choice<VehicleKind>("vehicle", {{"car", VehicleKind::kCar}, {"uav", VehicleKind::kUav}},
                            &route->vehicle);
  group.number("origin_latitude_deg", {-90.0, 90.0}, &route->origin.latitude, kDegree);
  group.number("origin_longitude_deg", {-180.0, 180.0}, &route->origin.longitude, kDegree);
  group.number("origin_height_m", {-1e3, 1e4}, &route->origin.height);
  group.number("standing_s", {0.0, 1e5}, &route->standing_s);
  group.number("block_m", {50.0, 5000.0}, &route->block_m);
  group.number("hill_m", {0.0, 500.0}, &route->hill_m);
  group.number("max_acceleration_m_s2", {0.1, 50.0}, &route->max_acceleration_m_s2);
  group.number("max_braking_m_s2", {0.1, 50.0}, &route->max_braking_m_s2);
  group.number("max_lateral_m_s2", {0.1, 50.0}, &route->max_lateral_m_s2);
  group.groups("waypoints", [&](ConfigReader& r) { read_waypoint(r, route); });
}

void read_sensor(ConfigReader& group, ImuConfig* imu) {
  group.boolean("enabled", &imu->enabled);
  group.boolean("ideal", &imu->ideal);
  group.number("rate_hz", {10.0, 1000.0}, &imu->rate_hz);
  read_imu(group, &imu->errors);
}

void read_shell(ConfigReader& group, ConstellationConfig* c) {
  OrbitShell shell;
  group.integer("planes", 1, 100, &shell.planes);
  group.integer("per_plane", 1, 100, &shell.per_plane);
  group.number("semi_major_axis_km", {6500.0, 1e5}, &shell.semi_major_axis_m, 1e3);
  group.number("eccentricity", {0.0, 0.5}, &shell.eccentricity);
  group.number("inclination_deg", {0.0, 180.0}, &shell.inclination, kDegree);
  group.number("node_span_deg", {0.0, 360.0}, &shell.node_span, kDegree);
  group.number("first_node_deg", kAngle, &shell.first_node, kDegree);
  group.number("phase_per_plane_deg", kAngle, &shell.phase_per_plane, kDegree);
  group.number("first_anomaly_deg", kAngle, &shell.first_anomaly, kDegree);
  if (shell.semi_major_axis_m == 0.0) group.fail("semi_major_axis_km", "must be given");
  c->shells.push_back(shell);
}

void read_constellation(ConfigReader& group, ConstellationConfig* c, NoiseConfig* noise) {
  group.boolean("enabled", &c->enabled);
  group.integer("first_number", 1, 399, &c->first_number);
  group.number("orbit_error_m", kSigma, &c->orbit_error_m);
  group.number("clock_error_m", kSigma, &c->clock_error_m);
  group.number("node_interval_s", {1.0, 900.0}, &c->node_interval_s);
  group.number("clock_interval_s", {1.0, 900.0}, &c->clock_interval_s);
  group.number("code_noise_m", kSigma, &noise->code_m);
  group.number("carrier_noise_m", kSigma, &noise->carrier_m);
  group.number("doppler_noise_m_s", kSigma, &noise->doppler_m_s);
  ConstellationConfig own;
  if (group.groups("shells", [&](ConfigReader& r) { read_shell(r, &own); })) c->shells = own.shells;
}

void read_receiver(ConfigReader& group, ReceiverConfig* receiver) {
  group.number("interval_s", {0.05, 900.0}, &receiver->interval_s);
  group.vector("lever_arm_b_m", {-100.0, 100.0}, &receiver->lever_arm_b);
  group.number("elevation_mask_deg", {0.0, 90.0}, &receiver->elevation_mask, kDegree);
  group.number("clock_offset_us", {-1e3, 1e3}, &receiver->clock_offset_s, 1e-6);
  group.number("clock_drift_ppb", {-1e4, 1e4}, &receiver->clock_drift, 1e-9);
  group.number("clock_drift_walk_ppb_per_sqrt_s", {0.0, 1e3}, &receiver->clock_drift_walk, 1e-9);
  group.number("latency_s", {0.0, 10.0}, &receiver->gnss_latency_s);
}

void read_atmosphere(ConfigReader& group, AtmosphereConfig* atmosphere) {
  group.number("wet_offset_m", {-0.5, 0.5}, &atmosphere->wet_offset_m);
  group.number("wet_walk_m_per_sqrt_h", {0.0, 1.0}, &atmosphere->wet_walk_m_per_sqrt_s, 1.0 / 60.0);
  group.number("tecu", {0.0, 500.0}, &atmosphere->tecu);
  group.number("tec_gradient_per_km", {-0.1, 0.1}, &atmosphere->tec_gradient_per_km);
}

void read_root(ConfigReader& root, Scenario* scenario) {
  double seed = 1.0, week = 2136.0, tow_s = 345'600.0;
  root.text("name", &scenario->name);
  root.number("seed", {0.0, 9e15}, &seed);
  root.number("start_gps_week", {1.0, 9999.0}, &week);
  root.number("start_gps_tow_s", {0.0, 604'799.0}, &tow_s);
  scenario->seed = static_cast<std::uint64_t>(seed);
  scenario->start = GpsTime::from_week_and_tow(static_cast<int>(week), tow_s);
  root.number("duration_s", {10.0, 86'400.0}, &scenario->duration_s);
  root.group("route", [&](ConfigReader& r) { read_route(r, &scenario->route); });
  root.group("imu", [&](ConfigReader& r) { read_sensor(r, &scenario->imu); });
  root.group("satellites", [&](ConfigReader& satellites) {
    for (const System system : kSystems) {
      const std::size_t i = index_of(system);
      satellites.group(std::string(to_string(system)).c_str(), [&](ConfigReader& r) {
        read_constellation(r, &scenario->constellations[i], &scenario->receiver.noise[i]);
      });
    }
  });
  root.group("receiver", [&](ConfigReader& r) { read_receiver(r, &scenario->receiver); });
  root.group("atmosphere", [&](ConfigReader& r) { read_atmosphere(r, &scenario->atmosphere); });
}

// The papers' tactical unit (POS320, Remote Sensing 2024, 16, 1782, table 1).
ImuErrorModel tactical_imu() {
  ImuErrorModel imu;
  imu.angle_random_walk = 0.05 * kDegree / 60.0;
  imu.velocity_random_walk = 0.1 / 60.0;
  imu.gyro_bias = {0.5 * kDegree / 3600.0, 3600.0};
  imu.accel_bias = {25e-5, 3600.0};
  return imu;
}

Scenario default_scenario() {
  Scenario scenario;
  scenario.imu.errors = tactical_imu();
  for (const System system : kSystems) {
    scenario.constellations[index_of(system)] = nominal_constellation(system);
  }
  // Papers, section 3.1: 0.5 m and 3 mm.
  scenario.receiver.noise[index_of(System::kLeo)] = {0.5, 0.003, 0.05};
  return scenario;
}

}  // namespace

Scenario load_scenario(const std::string& path, const std::vector<std::string>& overrides) {
  return load_scenario_text(read_config_file(path), path, overrides);
}

Scenario load_scenario_text(const std::string& text, const std::string& name,
                            const std::vector<std::string>& overrides) {
  Scenario scenario = default_scenario();
  ConfigSource source{name, {}, {}};
  read_yaml(text, overrides, &source, [&](ConfigReader& root) { read_root(root, &scenario); });
  return scenario;
}

}  // namespace leonav::sim
