#include "tools/sim/scenario/scenario_yaml.h"

#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "daemon/config/config_file.h"
#include "tools/sim/scenario/nominal_constellations.h"

namespace leonav::sim {
namespace {

// Advances the sky by `seconds`: satellites move on, and the Earth turns below their planes.
void advance(double seconds, ConstellationConfig* constellation) {
  for (OrbitShell& shell : constellation->shells) {
    const double a = shell.semi_major_axis_m;
    shell.first_anomaly += seconds * std::sqrt(kEarthGravitationalConstant / (a * a * a));
    shell.first_node -= seconds * kEarthRotationRate;
  }
}

// Applies `ideal` of the whole scenario and of the receiver.
void remove_what_is_off(Scenario* scenario) {
  if (scenario->ideal) {
    scenario->imu.ideal = scenario->receiver.ideal = true;
    remove_unmodelled(&scenario->atmosphere);
    for (ConstellationConfig& c : scenario->constellations) {
      c.precise = c.broadcast.errors = {Eigen::Vector3d::Zero(), 0.0, 0.0, 0.0};
      // No product could follow this noise from node to node.
      c.clock.noise_s_per_sqrt_s = c.clock.drift_walk_per_sqrt_s = 0.0;
    }
  }
  replace_by_family(scenario->street_errors, &scenario->receiver);
  if (!scenario->receiver.ideal) return;
  remove_errors(&scenario->receiver);
  remove_errors(&scenario->street_errors);
}

void read_root(ConfigReader& root, const std::filesystem::path& folder, Scenario* scenario) {
  double seed = 1.0;
  std::optional<double> week, tow_s;
  root.text("name", &scenario->name);
  root.number("seed", {0.0, 9e15}, &seed);
  root.number("start_gps_week", {1.0, 9999.0}, &week);
  root.number("start_gps_tow_s", {0.0, 604'799.0}, &tow_s);
  if (seed != std::floor(seed)) root.report("seed", "must be a whole number");
  if (week && *week != std::floor(*week)) root.report("start_gps_week", "must be a whole number");
  scenario->seed = static_cast<std::uint64_t>(seed);
  root.number("duration_s", {10.0, 86'400.0}, &scenario->duration_s);
  root.number("truth_interval_s", {0.0, 60.0}, &scenario->truth_interval_s);
  root.group("route", [&](ConfigReader& r) { read_route(r, folder, &scenario->route); });
  scenario->start = GpsTime::from_week_and_tow(static_cast<int>(week.value_or(2136.0)),
                                               tow_s.value_or(345'600.0));
  const auto& track = scenario->route.track;
  if (!track.empty() && !week && !tow_s) scenario->start = track.front().time;
  root.group("imu", [&](ConfigReader& r) { read_sensor(r, &scenario->imu); });
  root.group("odometer", [&](ConfigReader& r) { read_odometer(r, &scenario->odometer); });
  double advance_s = 0.0;
  root.group("satellites", [&](ConfigReader& satellites) {
    satellites.number("advance_s", {0.0, 1e6}, &advance_s);
    for (const System system : kSystems) {
      const std::size_t i = index_of(system);
      satellites.group(std::string(to_string(system)).c_str(), [&](ConfigReader& r) {
        read_constellation(r, &scenario->constellations[i]);
      });
    }
  });
  for (ConstellationConfig& c : scenario->constellations) advance(advance_s, &c);
  root.group("receiver", [&](ConfigReader& r) { read_receiver(r, &scenario->receiver); });
  root.group("atmosphere", [&](ConfigReader& r) { read_atmosphere(r, &scenario->atmosphere); });
  read_places(root, &scenario->places);
  root.group("street_errors",
             [&](ConfigReader& r) { read_street_errors(r, folder, &scenario->street_errors); });
  root.groups("faults", [&](ConfigReader& r) { read_fault(r, &scenario->faults); });
  root.boolean("ideal", &scenario->ideal);
  remove_what_is_off(scenario);
}

Scenario default_scenario() {
  Scenario scenario;
  scenario.imu.errors = errors_of(ImuGrade::kTactical);
  for (const System system : kSystems) {
    scenario.constellations[index_of(system)] = nominal_constellation(system);
  }
  // These values are from the papers, section 3.1: 0.5 m and 3 mm.
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
  ConfigSource source{name};
  const std::filesystem::path folder = std::filesystem::path(name).parent_path();
  read_yaml(text, overrides, &source,
            [&](ConfigReader& root) { read_root(root, folder, &scenario); });
  scenario.given = std::move(source.given);
  for (ConstellationConfig& c : scenario.constellations) {
    if (!c.file.empty()) c.file = (folder / c.file).string();
  }
  return scenario;
}

}  // namespace leonav::sim
