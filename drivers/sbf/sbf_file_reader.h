// This unit reads a recorded file of SBF blocks, one output after the other.
#pragma once
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "drivers/sbf/sbf_decoder.h"

namespace leonav {

using SbfOutput = std::variant<RawEpoch, Ephemeris, KlobucharModel, std::vector<SignalBias>,
                               CorrectionPage, ExtSensorRates>;

// The file is read in chunks. The constructor and next() throw FileError if it cannot be opened or
// read.
class SbfFileReader {
 public:
  explicit SbfFileReader(const std::string& path);
  ~SbfFileReader();
  // Returns the next output in the order of the file; false at its end. The caller then checks
  // counters(): a file without any output is not an error here.
  bool next(SbfOutput* output);
  SbfCounters counters() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
