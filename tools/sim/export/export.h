// Export writes a simulated run as the files of a recording.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/gnss/propagation/antenna_model.h"
#include "core/inertial/strapdown/imu.h"
#include "drivers/csv/truth_csv.h"
#include "tools/sim/export/leo_as_gps.h"
#include "tools/sim/export/rinex_observation_writer.h"
#include "tools/sim/sky/broadcast.h"
#include "tools/sim/sky/products.h"

namespace leonav::sim {

// Settings of an export.
struct ExportOptions {
  std::string folder;  // created if it does not exist
  // Name low satellites as GPS satellites and leave out all others: leo_as_gps.h.
  bool leo_as_gps = false;
};

// Returns every file that an export to the folder may write.
std::vector<std::string> export_files(const ExportOptions& options);

// Export writes run.obs, run.nav, leo_elements.csv, one SP3 file per system (gps.sp3, ...),
// run.clk, antennas.atx, imu.csv, truth.csv, and the dataset.yaml that lists them. All functions
// throw FileError.
class Export {
 public:
  // `scenario` and `sky` must outlive this object.
  Export(const Scenario& scenario, const TrueSky& sky, const ExportOptions& options);

  void write(const Products& products, const BroadcastMessages& messages,
             std::span<const AntennaPattern> antennas);
  // These write in order of time. An epoch or sample not later than the one before is left out,
  // because the files cannot hold messages that arrive late or twice.
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
  bool has_navigation_ = false, has_leo_elements_ = false, has_clocks_ = false;
};

}  // namespace leonav::sim
