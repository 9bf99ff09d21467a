// This unit opens observation files of every format behind one interface.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "core/gnss/signals/observation.h"
#include "tools/import/import_report.h"

namespace leonav {

using ObservationItem = std::variant<RawEpoch, Ephemeris, KlobucharModel, std::vector<SignalBias>>;

// An observation file of any format.
class ObservationFile {
 public:
  virtual ~ObservationFile() = default;
  virtual bool next(ObservationItem* item) = 0;
  virtual std::string antenna() const { return {}; }
  virtual long line_number() const { return 0; }  // line of the last epoch read; 0: not a text file
  virtual long lost_epochs() const = 0;           // epochs that could not be read
  virtual void report(const std::string& path, ImportReport* report) const = 0;
};

// Opens a file in the format that the end of its name tells: .ubx, .oem7 or .gps (NovAtel), .sbf
// (Septentrio), .rtcm3 or .rtcm, otherwise RINEX. `date` is that of the dataset; unset: not given.
// Throws FileError for a file that cannot be opened, and for one whose messages lack the week where
// no date is given.
std::unique_ptr<ObservationFile> open_observation_file(const std::string& path, GpsTime date);

// Returns whether a file name ends so, in upper or lower case.
bool has_ending(const std::string& path, std::string_view lower_case_ending);

}  // namespace leonav
