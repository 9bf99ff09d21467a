// A producer waits for room with a Backoff: it first yields to other threads, then sleeps.
#pragma once
#include <sched.h>

#include <ctime>

namespace leonav {

class Backoff {
 public:
  void pause() {
    if (++rounds_ <= 16) {
      sched_yield();
      return;
    }
    // A yield never lets a thread of lower priority run; a sleep does.
    const timespec time{0, 100'000};
    nanosleep(&time, nullptr);
  }

 private:
  int rounds_ = 0;
};

}  // namespace leonav
