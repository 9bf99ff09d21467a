// Runs the program that inertial readings and time marks are compared with, where it is installed.
#pragma once
#include <cstdlib>
#include <iostream>
#include <string>

namespace leonav::test {

// The Python that has pyubx2: $LEONAV_PYTHON, otherwise python3.
inline std::string ubx_oracle() {
  const char* python = std::getenv("LEONAV_PYTHON");
  return std::string("'") + (python != nullptr ? python : "python3") +
         "' '" LEONAV_SOURCE_DIR "/test/oracle/ubx.py' ";
}

// True if it is there; otherwise it prints that the test is skipped.
inline bool have_pyubx2() {
  if (std::system((ubx_oracle() + "--have >/dev/null 2>&1").c_str()) == 0) return true;
  std::cout << "SKIPPED (optional): no Python with pyubx2 (LEONAV_PYTHON names another)\n";
  return false;
}

}  // namespace leonav::test
