// thread_processor_s returns the processor time of the calling thread.
#pragma once
#include <ctime>

namespace leonav {

// In seconds since the thread started; unlike wall time, without what other threads take.
inline double thread_processor_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace leonav
