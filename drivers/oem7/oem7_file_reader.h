// This unit reads a recorded file of NovAtel bytes, one output after the other.
#pragma once
#include <memory>
#include <string>
#include <variant>

#include "drivers/oem7/oem7_decoder.h"

namespace leonav {

using Oem7Output = std::variant<RawEpoch, Ephemeris, KlobucharModel, RawImuIncrements>;

// The file is read in chunks. The constructor and next() throw FileError if it cannot be opened or
// read.
class Oem7FileReader {
 public:
  explicit Oem7FileReader(const std::string& path, const Oem7Options& options = {});
  ~Oem7FileReader();
  // Returns the next output in the order of the file; false at its end. The caller then checks
  // counters(): a file without any output is not an error here.
  bool next(Oem7Output* output);
  Oem7Counters counters() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
