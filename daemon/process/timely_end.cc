#include "daemon/process/timely_end.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <tuple>

namespace leonav {
namespace {

extern "C" void end_at_once(int) {
  constexpr char kText[] = "leonavd: error: a thread does not end; ended without it\n";
  std::ignore = write(STDERR_FILENO, kText, sizeof kText - 1);
  _exit(EXIT_FAILURE);
}

}  // namespace

void end_within(unsigned seconds) {
  std::signal(SIGALRM, end_at_once);
  alarm(seconds);
}

}  // namespace leonav
