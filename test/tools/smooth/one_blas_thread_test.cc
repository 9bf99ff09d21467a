// The programs that use Ceres by themselves have one thread before they read their log.
#include <unistd.h>

#include "support/catch.h"
#include "support/programs/program_run.h"

namespace leonav::test {
namespace {

// Runs a program on a pipe that nobody writes to, and returns how many threads it has once it has
// opened that; 0: it did not get so far.
int threads_before_reading(const std::string& program, const std::string& options) {
  const TemporaryFile place("unused", "");
  const std::string script = place.beside("count.sh");
  std::ofstream(script) << "cd '" << place.beside(".") << "' && mkfifo log || exit 1\n"
                        << "env -u OPENBLAS_NUM_THREADS '" << LEONAV_BIN_DIR "/" << program << "' "
                        << options << " log >/dev/null 2>&1 &\n"
                        << "exec 3>log\nls /proc/$!/task | wc -l\n"
                        << "kill $!\nexec 3>&-\nwait\n";
  const std::string counted = place.beside("count");
  const int status = std::system(("timeout 60 bash '" + script + "' >'" + counted + "'").c_str());
  const std::string text = text_of(counted);
  return status == 0 || !text.empty() ? std::atoi(text.c_str()) : 0;
}

}  // namespace

TEST_CASE("tools that use Ceres do not start threads of OpenBLAS") {
  if (!have_programs("leonav-smooth", "leonav-calibrate", "leonav-bench")) return;
  if (sysconf(_SC_NPROCESSORS_ONLN) < 2) {
    std::cout << "SKIPPED: with one processor there are no such threads\n";
    return;
  }
  CHECK(threads_before_reading("leonav-smooth", "--preset car --out out") == 1);
  CHECK(threads_before_reading("leonav-calibrate", "--preset car") == 1);
  CHECK(threads_before_reading("leonav-bench", "--preset car") == 1);
}

}  // namespace leonav::test
