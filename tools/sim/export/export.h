// A simulated run as the files that a recording would come in.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/gnss/antenna_model.h"
#include "core/ins/imu.h"
#include "drivers/csv/truth_csv.h"
#include "tools/sim/export/leo_as_gps.h"
#include "tools/sim/export/rinex_observation_writer.h"
#include "tools/sim/sky/broadcast.h"
#include "tools/sim/sky/products.h"

namespace leonav::sim {

struct ExportOptions {
  std::string folder;  // made if it is not there
  // Low satellites under GPS names in the place of all others: leo_as_gps.h.
  bool leo_as_gps = false;
};

// Every file that an export to the folder may write.
std::vector<std::string> export_files(const ExportOptions& options);

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
  void write_products(const Products& products);
  void write_dataset() const;

  ExportOptions options_;
  std::optional<LeoAsGps> renamed_;
  std::unique_ptr<RinexObservationWriter> observations_;
  GpsTime last_epoch_;
  std::vector<ImuSample> imu_;
  std::vector<std::string> orbit_files_;
  bool has_navigation_ = false, has_clocks_ = false;
};

}  // namespace leonav::sim
