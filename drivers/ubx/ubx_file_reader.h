// This unit reads a recorded UBX file, one output after the other.
#pragma once
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "drivers/ubx/ubx_decoder.h"

namespace leonav {

using UbxOutput = std::variant<RawEpoch, Ephemeris, KlobucharModel, std::vector<SignalBias>,
                               EsfReading, CorrectionPage>;

// The file is read in chunks. The constructor and next() throw FileError if it cannot be opened or
// read.
class UbxFileReader {
 public:
  explicit UbxFileReader(const std::string& path, const RxmRawxOptions& options = {});
  ~UbxFileReader();
  // Returns the next output in the order of the file; false at its end. The caller then checks
  // counters(): a file without any output is not an error here.
  bool next(UbxOutput* output);
  UbxCounters counters() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
