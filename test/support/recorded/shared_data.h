// Recorded data sets that lie outside the project. A test that needs one is skipped, and says so,
// where they are absent.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

namespace leonav::test {

// Root of the data sets: $LEONAV_DATA if set, otherwise ../shared/data beside the source tree.
inline std::string shared_data_root() {
  const char* from_environment = std::getenv("LEONAV_DATA");
  return from_environment != nullptr ? from_environment : LEONAV_SHARED_DATA;
}

// True if `relative_path` exists; otherwise prints that the test is skipped.
inline bool have_shared_data(const std::string& relative_path) {
  if (std::filesystem::exists(shared_data_root() + "/" + relative_path)) return true;
  std::cout << "SKIPPED: recorded data " << relative_path << " is not on this machine\n";
  return false;
}

inline std::string shared_data(const std::string& relative_path) {
  return shared_data_root() + "/" + relative_path;
}

}  // namespace leonav::test
