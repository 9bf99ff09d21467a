// This unit reads u-blox files for the import: observations with the navigation data between them,
// or the samples of the inertial sensor.
#pragma once
#include <string>
#include <vector>

#include "core/inertial/strapdown/imu.h"
#include "drivers/ubx/ubx_file_reader.h"
#include "tools/import/internal/observation_file.h"

namespace leonav {

// Returns whether the name ends in .ubx.
bool has_ubx_name(const std::string& path);

// A recorded stream as a source of epochs, ephemerides and ionosphere coefficients.
class UbxFile final : public ObservationFile {
 public:
  explicit UbxFile(const std::string& path) : reader_(path) {}

  bool next(ObservationItem* item) override;
  long lost_epochs() const override;
  void report(const std::string& path, ImportReport* report) const override;

 private:
  UbxFileReader reader_;
};

// Reads the samples of a file, in its order. `gnss_latency_s`: an epoch was written so long after
// its time. Throws FileError for a file that cannot be read or gives no sample, with the reasons.
std::vector<ImuSample> read_ubx_imu(const std::string& path, double gnss_latency_s,
                                    ImportReport* report);

}  // namespace leonav
