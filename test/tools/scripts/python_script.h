// Scripts in Python that use the modules of tools/scripts.
#pragma once
#include <cstdlib>
#include <string>

#include "support/catch.h"
#include "support/programs/program_run.h"
#include "support/temporary_file.h"

namespace leonav::test {

// What a script prints that imports modules of a folder of tools/scripts.
inline std::string python_script(const std::string& folder, const std::string& script) {
  const TemporaryFile file("script.py", "import sys\nsys.path.insert(0, '" LEONAV_SOURCE_DIR
                                        "/tools/scripts/" +
                                            folder + "')\n" + script);
  const std::string out = file.beside("out");
  const std::string command = "/usr/bin/python3 -B '" + file.path() + "' >'" + out + "' 2>&1";
  const int status = std::system(command.c_str());
  INFO(text_of(out));
  CHECK(status == 0);
  return text_of(out);
}

}  // namespace leonav::test
