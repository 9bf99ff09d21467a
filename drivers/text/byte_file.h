// This unit reads the bytes of a file in chunks.
#pragma once
#include <array>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>

namespace leonav {

// The constructor and next() throw FileError (drivers/text/parse.h) if the file cannot be opened or
// read; `what` says what it should hold, as in "name a file of RTCM 3 bytes".
class ByteFile {
 public:
  ByteFile(const std::string& path, const std::string& what);

  // Returns the next bytes, valid until the next call; none at the end of the file.
  std::span<const std::uint8_t> next();

 private:
  std::string path_;
  std::ifstream file_;
  std::array<char, 4096> chunk_;
};

}  // namespace leonav
