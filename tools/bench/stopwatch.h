// Stopwatch measures wall time and processor time, because on a busy machine the former includes
// other work.
#pragma once
#include <chrono>
#include <vector>

#include "daemon/threads/thread_time.h"

namespace leonav {

// Durations in seconds; both vectors have the same length.
struct Times {
  std::vector<double> wall_s, processor_s;

  void reserve(std::size_t count) {
    // The memory is touched here too: memory that grows with the durations would be counted as the
    // navigator's.
    wall_s.assign(count, 0.0);
    processor_s.assign(count, 0.0);
    clear();
  }
  void clear() {
    wall_s.clear();
    processor_s.clear();
  }
  void append(const Times& more) {
    wall_s.insert(wall_s.end(), more.wall_s.begin(), more.wall_s.end());
    processor_s.insert(processor_s.end(), more.processor_s.begin(), more.processor_s.end());
  }
};

// Stopwatch starts when it is constructed.
class Stopwatch {
 public:
  // Appends the time since construction.
  void stop(Times* times) const {
    // The wall time is read first, because reading the processor time takes longer.
    const double wall_s = std::chrono::duration<double>(Clock::now() - wall_).count();
    times->processor_s.push_back(thread_processor_s() - processor_s_);
    times->wall_s.push_back(wall_s);
  }

 private:
  using Clock = std::chrono::steady_clock;

  double processor_s_ = thread_processor_s();
  Clock::time_point wall_ = Clock::now();
};

}  // namespace leonav
