#include "tools/sim/scenario/scenario_yaml.h"

#include <numbers>

#include "daemon/config/config_file.h"
#include "tools/sim/scenario/nominal_constellations.h"

namespace leonav::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

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
        read_constellation(r, &scenario->constellations[i]);
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
