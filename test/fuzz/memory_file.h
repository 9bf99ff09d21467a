// A MemoryFile is a file in memory that readers open by a path. Only its owner may read it, as a
// secret must be kept.
#pragma once
#include <string>

#include "test/fuzz/fuzz_target.h"

namespace leonav::test {

class MemoryFile {
 public:
  MemoryFile();  // throws std::system_error
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  // Replaces the content. Throws std::system_error.
  void write(FuzzBytes bytes);
  const std::string& path() const { return path_; }

 private:
  int descriptor_;
  std::string path_;
};

// The path of one file that holds `bytes` until the next call.
const std::string& path_of_file_with(FuzzBytes bytes);

}  // namespace leonav::test
