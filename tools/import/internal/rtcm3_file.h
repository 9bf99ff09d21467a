// This unit reads RTCM 3 files for the import: observations with what comes between them, or
// ephemerides alone.
#pragma once
#include <string>
#include <vector>

#include "drivers/rtcm3/rtcm3_file_reader.h"
#include "tools/import/internal/observation_file.h"

namespace leonav {

// Returns whether the name ends in .rtcm3 or .rtcm.
bool has_rtcm3_name(const std::string& path);

// Opens a file whose messages lack the week. Throws FileError if it cannot be opened, or `date` is
// unset.
Rtcm3FileReader open_rtcm3(const std::string& path, GpsTime date);

// Reports what a file held that was not used.
void report_rtcm3(const std::string& path, const Rtcm3Counters& counters, ImportReport* report);

// A recorded stream as a source of epochs and ephemerides.
class Rtcm3File final : public ObservationFile {
 public:
  // Throws FileError if `date` is unset: the messages give times of week without the week.
  Rtcm3File(const std::string& path, GpsTime date);

  bool next(ObservationItem* item) override;
  // Returns the antenna that the stream names anywhere.
  std::string antenna() const override { return antenna_; }
  long lost_epochs() const override;
  void report(const std::string& path, ImportReport* report) const override;

 private:
  Rtcm3FileReader reader_;
  std::string antenna_;
};

// Reads the ephemerides of a file, in its order; what else it holds is counted as not used. Throws
// FileError as Rtcm3File does, and for a file without a usable ephemeris.
std::vector<Ephemeris> read_rtcm3_ephemerides(const std::string& path, GpsTime date,
                                              ImportReport* report);

}  // namespace leonav
