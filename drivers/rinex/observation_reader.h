// Streams the epochs of a RINEX observation file, versions 2.00 to 3.05.
#pragma once
#include <memory>
#include <string>

#include "core/gnss/observation.h"
#include "drivers/rinex/observation_header.h"
#include "drivers/rinex/read_counts.h"

namespace leonav {

// Source: RINEX 2.11 (Gurtner, Estey 2007), RINEX 3.05 (IGS/RTCM 2020). Times come out in GPS time,
// values as core/gnss/observation.h says. What cannot be used is counted with its reason and first
// line; a file with no usable epoch is for the caller to refuse (counts().used == 0).
class ObservationReader {
 public:
  // Reads the header. Throws FileError if the file cannot be opened, is compressed, is no RINEX
  // observation file, has a version other than 2 or 3, or has a damaged header.
  explicit ObservationReader(const std::string& path);
  ~ObservationReader();
  ObservationReader(ObservationReader&&) noexcept;
  ObservationReader& operator=(ObservationReader&&) noexcept;

  // Next epoch with at least one observation; false at the end of the file. Epochs come as they
  // stand in the file: their order in time is for the caller to judge, who knows the files around.
  bool next(RawEpoch* epoch);
  long line_number() const;  // of the line that begins the epoch handed on last

  const ObservationHeader& header() const;
  const ReadCounts& counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
