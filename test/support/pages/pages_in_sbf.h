// Recorded pages of corrections, put into the blocks of a Septentrio receiver by an encoder in
// Python that was written from the guide.
#pragma once
#include <cstdlib>
#include <string>

namespace leonav::test {

// Writes the lines of a file of pages as blocks to `target`; `service` is "has" or "b2b". Returns
// whether it could. Where pysbf2 is there ($LEONAV_PYTHON, otherwise python3), some of the blocks
// are packed by it too and compared.
inline bool write_pages_as_sbf(const std::string& service, const std::string& pages,
                               const std::string& target) {
  const char* python = std::getenv("LEONAV_PYTHON");
  const std::string command = std::string("'") + (python != nullptr ? python : "python3") +
                              "' '" LEONAV_SOURCE_DIR "/test/oracle/sbf.py' " + service + " '" +
                              pages + "' >'" + target + "'";
  return std::system(command.c_str()) == 0;
}

}  // namespace leonav::test
