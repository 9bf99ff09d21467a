#include "tools/sim/export/export.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "drivers/csv/imu_csv.h"
#include "tools/sim/export/antex_writer.h"
#include "tools/sim/export/clock_writer.h"
#include "tools/sim/export/rinex_navigation_writer.h"
#include "tools/sim/export/sp3_writer.h"
#include "tools/sim/signals/signal_plan.h"

namespace leonav::sim {
namespace {

constexpr const char* kAntennaName = "LEONAV_ZERO     NONE";

std::vector<SignalCode> plan_of(System system) {
  const auto signals = signals_of(system);
  return {signals.begin(), signals.end()};
}

}  // namespace

Export::Export(const Scenario& scenario, const TrueSky& sky, const ExportOptions& options)
    : options_(options) {
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) throw FileError(options.folder, 0, "cannot be made: " + error.message());
  if (options.leo_as_gps) renamed_.emplace(scenario, sky);
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

// A file of orbits per system: their nodes are not equally far apart.
void Export::write_products(const Products& products) {
  for (const System system : kSystems) {
    std::vector<OrbitEpoch> own;
    for (const OrbitEpoch& epoch : products.orbits) {
      own.push_back({epoch.time, {}});
      std::copy_if(epoch.states.begin(), epoch.states.end(), std::back_inserter(own.back().states),
                   [system](const PreciseState& s) { return s.satellite.system == system; });
      if (own.back().states.empty()) own.pop_back();
    }
    if (own.empty()) continue;
    orbit_files_.push_back(std::string(to_string(system)) + ".sp3");
    write_sp3(path(orbit_files_.back()), own);
  }
  has_clocks_ = !products.clocks.empty();
  if (has_clocks_) write_rinex_clock(path("run.clk"), products.clocks);
}

void Export::write(const Products& products, const BroadcastMessages& messages,
                   std::span<const AntennaPattern> antennas) {
  write_products(renamed_ ? renamed_->products() : products);
  const std::vector<Ephemeris> ephemerides =
      renamed_ ? renamed_->elements(messages) : messages.ephemerides;
  has_navigation_ = !ephemerides.empty();
  if (has_navigation_) write_rinex_navigation(path("run.nav"), ephemerides);
  if (renamed_) {
    write_antex(path("antennas.atx"), renamed_->antennas(antennas), kAntennaName);
  } else {
    write_antex(path("antennas.atx"), antennas, kAntennaName);
  }
}

void Export::write(const RawEpoch& epoch) {
  if (last_epoch_.is_set() && epoch.time <= last_epoch_) return;
  last_epoch_ = epoch.time;
  observations_->write(renamed_ ? renamed_->epoch(epoch) : epoch);
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
