// This unit reads Septentrio files for the import: observations with the navigation data between
// them, or the samples of the inertial sensor.
#pragma once
#include <string>
#include <vector>

#include "core/inertial/strapdown/imu.h"
#include "drivers/sbf/sbf_file_reader.h"
#include "tools/import/internal/observation_file.h"

namespace leonav {

// Returns whether the name ends in .sbf.
bool has_sbf_name(const std::string& path);

// A recorded stream as a source of epochs, ephemerides and ionosphere coefficients.
class SbfFile final : public ObservationFile {
 public:
  explicit SbfFile(const std::string& path) : reader_(path) {}

  bool next(ObservationItem* item) override;
  long lost_epochs() const override;
  void report(const std::string& path, ImportReport* report) const override;

 private:
  SbfFileReader reader_;
};

// Reads the samples of a file, in its order. Throws FileError for a file that cannot be read or
// gives no sample, with the reasons.
std::vector<ImuSample> read_sbf_imu(const std::string& path, ImportReport* report);

}  // namespace leonav
