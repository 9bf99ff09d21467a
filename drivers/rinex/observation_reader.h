// This unit streams the epochs of a RINEX observation file, versions 2.00 to 3.05.
#pragma once
#include <memory>
#include <string>

#include "core/gnss/signals/observation.h"
#include "drivers/epoch/epoch_capacity.h"
#include "drivers/rinex/observation_header.h"
#include "drivers/rinex/read_counts.h"

namespace leonav {

// Source: RINEX 2.11 (Gurtner, Estey 2007), RINEX 3.05 (IGS/RTCM 2020). Times are converted to GPS
// time; values are those of core/gnss/signals/observation.h. Records that cannot be used are
// counted with their reason and first line; signals beyond the capacity of an epoch are counted in
// losses(). The caller must refuse a file without a usable epoch
// (counts().used == 0).
class ObservationReader {
 public:
  // Reads the header. Throws FileError if the file cannot be opened, is compressed, is no RINEX
  // observation file, has a version other than 2 or 3, or has a damaged header.
  explicit ObservationReader(const std::string& path);
  ~ObservationReader();
  ObservationReader(ObservationReader&&) noexcept;
  ObservationReader& operator=(ObservationReader&&) noexcept;

  // Reads the next epoch with at least one observation; returns false at the end of the file.
  // Epochs come in the order of the file: the caller, which may have several files, tests their
  // order in time.
  bool next(RawEpoch* epoch);
  long line_number() const;  // of the first line of the last epoch

  const ObservationHeader& header() const;
  const ReadCounts& counts() const;
  const CapacityLosses& losses() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
