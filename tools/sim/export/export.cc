#include "tools/sim/export/export.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>

#include "drivers/csv/imu_csv.h"
#include "drivers/csv/leo_elements_csv.h"
#include "tools/sim/export/antex_writer.h"
#include "tools/sim/export/clock_writer.h"
#include "tools/sim/export/rinex_navigation_writer.h"
#include "tools/sim/export/sp3_writer.h"
#include "tools/sim/signals/signal_plan.h"

namespace leonav::sim {
namespace {

constexpr const char* kAntennaName = "LEONAV_ZERO     NONE";
constexpr const char *kObservations = "run.obs", *kNavigation = "run.nav", *kClocks = "run.clk",
                     *kAntennas = "antennas.atx", *kImu = "imu.csv", *kTruth = "truth.csv",
                     *kDataset = "dataset.yaml", *kLeoElements = "leo_elements.csv";
constexpr const char *kToldOrbits =
                         "Simulated by leonav-sim: what the receiver is told, errors included",
                     *kTrueOrbits =
                         "Simulated by leonav-sim: low satellites as GPS, without any error";

std::string orbit_file(System system) { return std::string(to_string(system)) + ".sp3"; }

std::vector<SignalCode> plan_of(const Scenario& scenario, System system) {
  const auto signals = signals_of(scenario, system);
  return {signals.begin(), signals.end()};
}

}  // namespace

std::vector<std::string> export_files(const ExportOptions& options) {
  std::vector<std::string> names = {kObservations, kNavigation, kClocks,  kAntennas,
                                    kImu,          kTruth,      kDataset, kLeoElements};
  for (const System system : kSystems) names.push_back(orbit_file(system));
  for (std::string& name : names) {
    name = (std::filesystem::path(options.folder) / name).string();
  }
  return names;
}

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
    header.signals[System::kGps] = plan_of(scenario, System::kLeo);
  } else {
    for (const TrueSatellite& satellite : sky.satellites) {
      header.signals.try_emplace(satellite.id.system, plan_of(scenario, satellite.id.system));
    }
  }
  observations_ = std::make_unique<RinexObservationWriter>(path(kObservations), std::move(header));
}

std::string Export::path(const std::string& name) const {
  return (std::filesystem::path(options_.folder) / name).string();
}

// Each system has its own file of orbits, because the node intervals differ.
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
    orbit_files_.push_back(orbit_file(system));
    write_sp3(path(orbit_files_.back()), own, renamed_ ? kTrueOrbits : kToldOrbits);
  }
  has_clocks_ = !products.clocks.empty();
  if (has_clocks_) write_rinex_clock(path(kClocks), products.clocks);
}

void Export::write(const Products& products, const BroadcastMessages& messages,
                   std::span<const AntennaPattern> antennas) {
  write_products(renamed_ ? renamed_->products() : products);
  const std::vector<Ephemeris> ephemerides =
      renamed_ ? renamed_->elements(messages) : messages.ephemerides;
  const auto is_leo = [](const Ephemeris& e) { return e.satellite.system == System::kLeo; };
  has_navigation_ = !std::all_of(ephemerides.begin(), ephemerides.end(), is_leo);
  if (has_navigation_) write_rinex_navigation(path(kNavigation), ephemerides);
  has_leo_elements_ = std::any_of(ephemerides.begin(), ephemerides.end(), is_leo);
  if (has_leo_elements_) write_leo_elements_csv(path(kLeoElements), ephemerides);
  if (renamed_) {
    write_antex(path(kAntennas), renamed_->antennas(antennas), kAntennaName);
  } else {
    write_antex(path(kAntennas), antennas, kAntennaName);
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
  if (!imu_.empty()) write_imu_csv(path(kImu), imu_);
  write_truth_csv(path(kTruth), truth);
  write_dataset();
}

void Export::write_dataset() const {
  TextFile file(path(kDataset));
  const auto entry = [&](std::string_view key, std::string_view value) {
    std::string text(key);
    file.line(text.append(": ").append(value));
  };
  file.line("# Written by leonav-sim.");
  entry("name", "simulated");
  entry("observations", kObservations);
  if (has_navigation_) entry("navigation", kNavigation);
  if (has_leo_elements_) entry("leo_elements", kLeoElements);
  std::string orbits;
  for (const std::string& name : orbit_files_) orbits += (orbits.empty() ? "" : ", ") + name;
  if (!orbits.empty()) entry("orbits", "[" + orbits + "]");
  if (has_clocks_) entry("clocks", kClocks);
  entry("antenna_models", kAntennas);
  if (!imu_.empty()) entry("imu", kImu);
  entry("truth", kTruth);
  file.close();
}

}  // namespace leonav::sim
