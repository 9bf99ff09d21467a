// The observation files of a recording as one stream.
#pragma once
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/gnss/ephemeris.h"
#include "core/gnss/observation.h"
#include "tools/dataset/import_report.h"

namespace leonav {

using ObservationItem = std::variant<RawEpoch, Ephemeris, KlobucharModel>;

// Reads RINEX and .ubx files one after the other. Epochs come in strictly increasing time: one
// whose time contradicts those around it, of its file or the next, is counted and left out, and its
// losses of lock are passed on. UBX files give the navigation data they hold too, in place.
class ObservationSource {
 public:
  // `report` gets what the files leave out, file by file, and must outlive this.
  ObservationSource(std::vector<std::string> paths, ImportReport* report);
  ~ObservationSource();

  // False at the end of the last file. Throws FileError for a file that cannot be read or has no
  // usable epoch.
  bool next(ObservationItem* item);
  // The antenna that the header of the first file names that names one; empty: none, or not opened.
  const std::string& antenna() const;
  // Reports on what was read so far; for when no more is read.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
