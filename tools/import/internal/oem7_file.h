// This unit reads NovAtel files for the import: observations with the navigation data between them,
// or the samples of the inertial sensor.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/inertial/strapdown/imu.h"
#include "drivers/oem7/oem7_file_reader.h"
#include "tools/import/internal/observation_file.h"

namespace leonav {

// Returns whether the name ends in .oem7 or .gps, as NovAtel's programs name their recordings.
bool has_oem7_name(const std::string& path);

// A recorded stream as a source of epochs, ephemerides and ionosphere coefficients.
class Oem7File final : public ObservationFile {
 public:
  explicit Oem7File(const std::string& path) : reader_(path) {}

  bool next(ObservationItem* item) override;
  long lost_epochs() const override;
  void report(const std::string& path, ImportReport* report) const override;

 private:
  Oem7FileReader reader_;
};

// Reads the samples of a file, in its order. `scale` is that of a count; empty: as documented for
// the type of the IMU. Throws FileError for a file that cannot be read or gives no sample, with the
// reasons.
std::vector<ImuSample> read_oem7_imu(const std::string& path, std::optional<ImuScale> scale,
                                     ImportReport* report);

}  // namespace leonav
