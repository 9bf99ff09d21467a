// Time by the wall and by the processor: on a machine with other work the first counts that too.
#pragma once
#include <chrono>
#include <ctime>
#include <vector>

namespace leonav {

// Seconds, in step.
struct Times {
  std::vector<double> wall_s, processor_s;

  void reserve(std::size_t count) {
    // Touched too: memory that comes with the notes would look like the navigator's.
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

class Stopwatch {
 public:
  void stop(Times* times) const {
    // The wall's clock is read inside the processor's, which takes longer to read.
    const double wall_s = std::chrono::duration<double>(Clock::now() - wall_).count();
    times->processor_s.push_back(processor_now_s() - processor_s_);
    times->wall_s.push_back(wall_s);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double processor_now_s() {  // of this thread
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  double processor_s_ = processor_now_s();
  Clock::time_point wall_ = Clock::now();
};

}  // namespace leonav
