// A simulated run as the files that a recording would come in.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/gnss/antenna_model.h"
#include "core/ins/imu.h"
#include "drivers/csv/truth_csv.h"
#include "tools/sim/export/rinex_observation_writer.h"
#include "tools/sim/sky/broadcast.h"
#include "tools/sim/sky/products.h"

namespace leonav::sim {

struct ExportOptions {
  std::string folder;  // made if it is not there
  // Low satellites alone, as G01 to G32 in order of their numbers (the first 32 that rise above the
  // mask): for programs that know no low satellites. Their elements, which such programs want too,
  // are fitted to arcs of 20 minutes.
  bool leo_as_gps = false;
};

// Writes run.obs, run.nav, one SP3 file per system (gps.sp3, ...), run.clk, antennas.atx, imu.csv,
// truth.csv, and the dataset.yaml that names them. Everything throws FileError.
class Export {
 public:
  // `scenario` and `sky` must outlive it.
  Export(const Scenario& scenario, const TrueSky& sky, const ExportOptions& options);

  void write(const Products& products, const BroadcastMessages& messages,
             std::span<const AntennaPattern> antennas);
  // In order of time; what is not later than the one before is left out: files have no place for
  // messages that come late or twice.
  void write(const RawEpoch& epoch);
  void write(const ImuSample& sample);
  void finish(std::span<const TruthPoint> truth);

 private:
  std::string path(const std::string& name) const;
  std::optional<SatelliteId> renamed(SatelliteId satellite) const;
  std::vector<OrbitEpoch> renamed(std::span<const OrbitEpoch> epochs, System system) const;
  std::vector<Ephemeris> elements_of_renamed() const;
  void choose_names();
  void write_dataset() const;

  const Scenario& scenario_;
  const TrueSky& sky_;
  ExportOptions options_;
  std::map<SatelliteId, SatelliteId> names_;  // low satellites' GPS names
  std::unique_ptr<RinexObservationWriter> observations_;
  GpsTime last_epoch_;
  std::vector<ImuSample> imu_;
  std::vector<std::string> orbit_files_;
  bool has_navigation_ = false, has_clocks_ = false;
};

}  // namespace leonav::sim
