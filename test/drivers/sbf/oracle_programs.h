// Runs the programs that the decoder is compared with, where they are installed.
#pragma once
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace leonav::test {

// The Python that has pysbf2: $LEONAV_PYTHON, otherwise python3.
inline std::string sbf_oracle() {
  const char* python = std::getenv("LEONAV_PYTHON");
  return std::string("'") + (python != nullptr ? python : "python3") +
         "' '" LEONAV_SOURCE_DIR "/test/oracle/sbf.py' ";
}

// Each is true if the program is there; otherwise it prints that the test is skipped.
inline bool have_pysbf2() {
  if (std::system((sbf_oracle() + "--have >/dev/null 2>&1").c_str()) == 0) return true;
  std::cout << "SKIPPED (optional): no Python with pysbf2 (LEONAV_PYTHON names another)\n";
  return false;
}
inline bool have_program(const std::string& name) {
  if (std::system(("command -v " + name + " >/dev/null").c_str()) == 0) return true;
  std::cout << "SKIPPED: " << name << " is not installed (apt-get install rtklib)\n";
  return false;
}

inline bool run(const std::string& command) { return std::system(command.c_str()) == 0; }

// The lines of a text file in words.
inline std::vector<std::vector<std::string>> words_of(const std::string& path) {
  std::vector<std::vector<std::string>> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::vector<std::string>& each = lines.emplace_back();
    for (std::string word; words >> word;) each.push_back(word);
  }
  return lines;
}

}  // namespace leonav::test
