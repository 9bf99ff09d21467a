// ObservationSource reads the observation files of a recording as one stream.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "tools/import/import_report.h"
#include "tools/import/internal/observation_file.h"

namespace leonav {

// RINEX, .ubx, .oem7, .gps (NovAtel), .sbf (Septentrio), .rtcm3 and .rtcm files are read one after
// the other, and epochs come in strictly increasing time.
//
// An epoch whose time contradicts those around it, in its file or the next, is counted and left
// out, and its losses of lock are passed on. UBX, NovAtel, Septentrio and RTCM 3 files also give
// the navigation data they hold, in the order of the file.
class ObservationSource {
 public:
  // `report` gets what the files leave out, file by file, and must outlive this object.
  // `date` is the dataset's, for files whose messages lack the week.
  ObservationSource(std::vector<std::string> paths, GpsTime date, ImportReport* report);
  ~ObservationSource();

  // Reads the next item; returns false at the end of the last file. Throws FileError for a file
  // that cannot be read or has no usable epoch.
  bool next(ObservationItem* item);
  // Returns the antenna of the first file header that names one; empty: none, or not opened yet.
  const std::string& antenna() const;
  // Reports on what was read so far; call it when no more will be read.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
