// A recorded UBX file, one output after the other.
#pragma once
#include <memory>
#include <string>
#include <variant>

#include "drivers/ubx/ubx_decoder.h"

namespace leonav {

using UbxOutput = std::variant<RawEpoch, Ephemeris, KlobucharModel>;

// Reads the file in chunks. Throws FileError if the file cannot be opened or read.
class UbxFileReader {
 public:
  explicit UbxFileReader(const std::string& path, const RxmRawxOptions& options = {});
  ~UbxFileReader();
  // The next output in the order of the file; false at its end. Check counters() then: a file in
  // which nothing was found is not an error here.
  bool next(UbxOutput* output);
  UbxCounters counters() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
