#include "daemon/process/timely_end.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "daemon/log/descriptor_write.h"

namespace leonav {
namespace {

extern "C" void end_at_once(int) {
  write_where_there_is_room(STDERR_FILENO,
                            "leonavd: error: a thread does not end; ended without it\n", 0);
  _exit(EXIT_FAILURE);
}

}  // namespace

void end_within(unsigned seconds) {
  std::signal(SIGALRM, end_at_once);
  alarm(seconds);
}

}  // namespace leonav
