#include "tools/sim/export/export.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "core/gnss/look_angles.h"
#include "drivers/csv/imu_csv.h"
#include "tools/sim/export/antex_writer.h"
#include "tools/sim/export/clock_writer.h"
#include "tools/sim/export/rinex_navigation_writer.h"
#include "tools/sim/export/sp3_writer.h"
#include "tools/sim/signals/signal_plan.h"

namespace leonav::sim {
namespace {

constexpr const char* kAntennaName = "LEONAV_ZERO     NONE";
constexpr std::size_t kGpsNames = 32;  // that programs for GPS count on

std::vector<SignalCode> plan_of(System system) {
  const auto signals = signals_of(system);
  return {signals.begin(), signals.end()};
}

}  // namespace

Export::Export(const Scenario& scenario, const TrueSky& sky, const ExportOptions& options)
    : scenario_(scenario), sky_(sky), options_(options) {
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) throw FileError(options.folder, 0, "cannot be made: " + error.message());
  if (options.leo_as_gps) choose_names();
  ObservationFileHeader header;
  header.marker = "SIMULATED";
  header.antenna = kAntennaName;
  header.position_e = to_ecef(scenario.route.origin);
  header.interval_s = scenario.receiver.interval_s;
  if (options.leo_as_gps) {
    header.signals[System::kGps] = plan_of(System::kLeo);
  } else {
    for (const TrueSatellite& satellite : sky.satellites) {
      header.signals.try_emplace(satellite.id.system, plan_of(satellite.id.system));
    }
  }
  observations_ = std::make_unique<RinexObservationWriter>(path("run.obs"), std::move(header));
}

std::string Export::path(const std::string& name) const {
  return (std::filesystem::path(options_.folder) / name).string();
}

void Export::choose_names() {
  const Eigen::Vector3d p_e = to_ecef(scenario_.route.origin);
  const double mask = scenario_.receiver.elevation_mask;
  for (const TrueSatellite& satellite : sky_.satellites) {
    if (satellite.id.system != System::kLeo || names_.size() == kGpsNames) continue;
    for (double t = 0.0; t <= scenario_.duration_s; t += 10.0) {
      if (look_angles(to_earth(satellite.orbit.at(t).p_i, t), p_e).elevation < mask) continue;
      const auto number = static_cast<std::uint16_t>(names_.size() + 1);
      names_[satellite.id] = {System::kGps, number};
      break;
    }
  }
}

std::optional<SatelliteId> Export::renamed(SatelliteId satellite) const {
  if (!options_.leo_as_gps) return satellite;
  const auto name = names_.find(satellite);
  return name == names_.end() ? std::nullopt : std::optional(name->second);
}

// Those of the system alone; epochs that are left empty are left out.
std::vector<OrbitEpoch> Export::renamed(std::span<const OrbitEpoch> epochs, System system) const {
  std::vector<OrbitEpoch> result;
  for (const OrbitEpoch& epoch : epochs) {
    OrbitEpoch left{epoch.time, {}};
    for (PreciseState state : epoch.states) {
      const auto name = renamed(state.satellite);
      if (!name || state.satellite.system != system) continue;
      state.satellite = *name;
      left.states.push_back(state);
    }
    if (!left.states.empty()) result.push_back(std::move(left));
  }
  return result;
}

std::vector<Ephemeris> Export::elements_of_renamed() const {
  constexpr double kInterval = 600.0;
  std::vector<Ephemeris> elements;
  for (const TrueSatellite& satellite : sky_.satellites) {
    const auto name = names_.find(satellite.id);
    if (name == names_.end()) continue;
    for (double toe = 0.0; toe <= scenario_.duration_s + 0.5 * kInterval; toe += kInterval) {
      const IssueRequest request{name->second, toe, kInterval, Eigen::Vector3d::Zero(), 0.0};
      elements.push_back(fit_issue(scenario_, satellite, request).elements);
      elements.back().transmission_time = elements.back().toe;
    }
  }
  return elements;
}

void Export::write(const Products& products, const BroadcastMessages& messages,
                   std::span<const AntennaPattern> antennas) {
  std::vector<OrbitEpoch> clocks;
  for (const System system : kSystems) {
    const std::vector<OrbitEpoch> orbits = renamed(products.orbits, system);
    const std::vector<OrbitEpoch> own_clocks = renamed(products.clocks, system);
    clocks.insert(clocks.end(), own_clocks.begin(), own_clocks.end());
    if (orbits.empty()) continue;
    orbit_files_.push_back(std::string(to_string(system)) + ".sp3");
    write_sp3(path(orbit_files_.back()), orbits);
  }
  std::stable_sort(clocks.begin(), clocks.end(),
                   [](const auto& a, const auto& b) { return a.time < b.time; });
  has_clocks_ = !clocks.empty();
  if (has_clocks_) write_rinex_clock(path("run.clk"), clocks);

  const std::vector<Ephemeris> ephemerides =
      options_.leo_as_gps ? elements_of_renamed() : messages.ephemerides;
  has_navigation_ = !ephemerides.empty();
  if (has_navigation_) write_rinex_navigation(path("run.nav"), ephemerides);

  std::vector<AntennaPattern> patterns;
  for (AntennaPattern pattern : antennas) {
    const auto name = pattern.is_receiver ? pattern.satellite : renamed(pattern.satellite);
    if (!name) continue;
    pattern.satellite = *name;
    patterns.push_back(pattern);
  }
  write_antex(path("antennas.atx"), patterns, kAntennaName);
}

void Export::write(const RawEpoch& epoch) {
  if (last_epoch_.is_set() && epoch.time <= last_epoch_) return;
  last_epoch_ = epoch.time;
  RawEpoch named = epoch;
  named.observations.clear();
  for (SignalObservation observation : epoch.observations) {
    const auto name = renamed(observation.satellite);
    if (!name) continue;
    observation.satellite = *name;
    named.observations.push_back(observation);
  }
  observations_->write(named);
}

void Export::write(const ImuSample& sample) {
  if (imu_.empty() || sample.time > imu_.back().time) imu_.push_back(sample);
}

void Export::finish(std::span<const TruthPoint> truth) {
  observations_->close();
  if (!imu_.empty()) write_imu_csv(path("imu.csv"), imu_);
  write_truth_csv(path("truth.csv"), truth);
  write_dataset();
}

void Export::write_dataset() const {
  TextFile file(path("dataset.yaml"));
  file.line("# Written by leonav-sim.");
  file.line("name: simulated");
  file.line("observations: run.obs");
  if (has_navigation_) file.line("navigation: run.nav");
  std::string orbits;
  for (const std::string& name : orbit_files_) orbits += (orbits.empty() ? "" : ", ") + name;
  if (!orbits.empty()) file.line("orbits: [" + orbits + "]");
  if (has_clocks_) file.line("clocks: run.clk");
  file.line("antenna_models: antennas.atx");
  if (!imu_.empty()) file.line("imu: imu.csv");
  file.line("truth: truth.csv");
  file.close();
}

}  // namespace leonav::sim
