// This unit reads a recorded RTCM 3 file, one output after the other.
#pragma once
#include <memory>
#include <string>
#include <variant>

#include "drivers/rtcm3/rtcm3_decoder.h"

namespace leonav {

using Rtcm3Output =
    std::variant<RawEpoch, Ephemeris, StationPosition, StationEquipment, SsrMessage>;

// The file is read in chunks. The constructor and next() throw FileError if it cannot be opened or
// read.
class Rtcm3FileReader {
 public:
  explicit Rtcm3FileReader(const std::string& path, const Rtcm3Options& options);
  ~Rtcm3FileReader();
  Rtcm3FileReader(Rtcm3FileReader&&) noexcept;
  // Returns the next output in the order of the file; false at its end. The caller then checks
  // counters(): a file without any output is not an error here.
  bool next(Rtcm3Output* output);
  Rtcm3Counters counters() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Returns the antenna (type and radome) that a file first names, or an empty text. It reads the
// file up to there and throws FileError if it cannot.
std::string first_antenna(const std::string& path);

}  // namespace leonav
