#include "daemon/process/one_blas_thread.h"

#include <unistd.h>

#include <climits>
#include <cstring>

namespace leonav {

// Libraries are not ready yet: nothing here allocates or throws, and what fails is left as it is.
void start_with_one_blas_thread(int, char** argv, char** environment) {
  constexpr int kMostVariables = 4096;
  static char setting[] = "OPENBLAS_NUM_THREADS=1";
  static char* variables[kMostVariables + 2];
  static char path[PATH_MAX];
  int count = 0;
  for (; environment[count] != nullptr; ++count) {
    // The name with its '=', whatever the value.
    const bool is_set = std::strncmp(environment[count], setting, sizeof setting - 2) == 0;
    if (is_set || count == kMostVariables) return;
    variables[count] = environment[count];
  }
  variables[count] = setting;
  const ssize_t size = readlink("/proc/self/exe", path, sizeof path - 1);
  if (size > 0) execve(path, argv, variables);
}

}  // namespace leonav
