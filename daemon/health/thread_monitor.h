// The ThreadMonitor finds the engine's threads that hang; only without one is the watchdog fed.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "daemon/engine/engine.h"

namespace leonav {

// A thread hangs if it has had work and finished nothing for longer than one piece of work may
// take: from one look to the next, and `gnss` for as long as a solve has where it does all of it,
// without an IMU. A thread without work is idle, for however long.
class ThreadMonitor {
 public:
  ThreadMonitor(Engine* engine, const NavigatorConfig& config);

  // The names of the threads that hang, as in "gnss, out"; empty: none. Call it once a second.
  std::string stalled_threads();

 private:
  Engine* engine_;
  static constexpr std::size_t kThreads = 4;
  std::array<WorkCount, kThreads> last_{};  // ins, gnss, smoother, out
  std::array<double, kThreads> most_looks_ = {1.0, 1.0, 1.0, 1.0};
  std::array<int, kThreads> looks_{};  // with work, of which nothing was finished
  std::int64_t last_io_rounds_ = -1;
};

}  // namespace leonav
