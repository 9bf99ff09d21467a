// Calls leonav-fleet as a user would, with programs that may be replaced.
#pragma once
#include <filesystem>
#include <fstream>
#include <string>

#include "support/catch.h"
#include "support/programs/program_run.h"

namespace leonav::test {

inline ProgramRun shell(const std::string& command) {
  const TemporaryFile place("unused", "");
  const std::string out = place.beside("out"), err = place.beside("err");
  const int status =
      std::system(("{ " + command + "; } >'" + out + "' 2>'" + err + "' </dev/null").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(out),
          text_of(err)};
}

// True if the programs are built and the packages there; otherwise prints that the test is skipped.
inline bool have_fleet() {
  if (!have_programs("leonav-sim", "leonav-replay", "leonav-eval", "leonav-fleet")) return false;
  static const bool there =
      shell("/usr/bin/python3 -c 'import distributed, cryptography, numpy'").exit_code == 0;
  if (there) return true;
  std::cout << "SKIPPED: no python3-distributed\n";
  return false;
}

inline ProgramRun fleet(const std::string& words) {
  return shell("timeout 300 '" LEONAV_BIN_DIR "/leonav-fleet' " + words);
}

// What a script prints that imports the fleet's modules.
inline std::string fleet_python(const std::string& script) {
  const TemporaryFile file("script.py", "import sys\nsys.path.insert(0, '" LEONAV_SOURCE_DIR
                                        "/tools/fleet')\n" +
                                            script);
  const ProgramRun run = shell("/usr/bin/python3 -B '" + file.path() + "'");
  INFO(run.out + run.err);
  CHECK(run.exit_code == 0);
  return run.out + run.err;
}

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline void write_program(const std::string& path, const std::string& text) {
  std::ofstream(path) << "#!/bin/sh\n" << text;
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
}

// A folder of the programs in which leonav-replay waits until the file go exists.
class WaitingPrograms {
 public:
  explicit WaitingPrograms(const TemporaryFile& place)
      : bin(place.beside("bin")), started(place.beside("started")), go(place.beside("go")) {
    std::filesystem::create_directories(bin);
    for (const std::string name : {"leonav-sim", "leonav-eval"})
      std::filesystem::create_symlink(LEONAV_BIN_DIR "/" + name, bin + "/" + name);
    write_program(bin + "/leonav-replay", "if [ ! -e '" + go + "' ]; then echo \"$$ $PPID\" >>'" +
                                              started + "'; fi\nwhile [ ! -e '" + go +
                                              "' ]; do sleep 0.1; done\nexec '" LEONAV_BIN_DIR
                                              "/leonav-replay' \"$@\"\n");
  }

  // leonav-fleet with `words`, disturbed as disturb.py says.
  ProgramRun disturbed(const std::string& what, const std::string& words) const {
    std::filesystem::remove(go);
    std::filesystem::remove(started);
    return shell(
        "timeout 300 /usr/bin/python3 -B '" LEONAV_SOURCE_DIR "/test/tools/fleet/disturb.py' " +
        what + " '" + started + "' '" + go + "' '" LEONAV_BIN_DIR "/leonav-fleet' " + words);
  }

  const std::string bin, started, go;
};

}  // namespace leonav::test
