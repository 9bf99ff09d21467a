// Runs one of the project's programs as a user would and keeps what it said.
#pragma once
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include "support/temporary_file.h"

namespace leonav::test {

struct ProgramRun {
  int exit_code = -1;
  std::string out, err;
};

inline std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// True if the programs are built; otherwise prints that the test is skipped.
template <typename... Names>
bool have_programs(const Names&... names) {
  for (const std::string& name : {std::string(names)...}) {
    if (std::filesystem::exists(std::string(LEONAV_BIN_DIR "/") + name)) continue;
    std::cout << "SKIPPED: " << name << " is not built\n";
    return false;
  }
  return true;
}

// For a program that hangs, and not for one that is slow: the machine may be busy.
inline constexpr const char* kProgramTimeout = "timeout 600 '";

// `arguments` as in a shell. A program that does not end within ten minutes is ended: exit code
// 124.
inline ProgramRun run_program(const std::string& name, const std::string& arguments) {
  const TemporaryFile place("unused", "");
  const std::string out = place.beside("out"), err = place.beside("err");
  std::string command = kProgramTimeout;
  command += LEONAV_BIN_DIR "/" + name + "' " + arguments;
  command += " >'" + out + "' 2>'" + err + "' </dev/null";
  const int status = std::system(command.c_str());
  ProgramRun run;
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.out = text_of(out);
  run.err = text_of(err);
  return run;
}

}  // namespace leonav::test
