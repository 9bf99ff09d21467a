// The ThreadMonitor finds the engine's threads that hang; only without one is the watchdog fed.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "daemon/engine/engine.h"

namespace leonav {

// A thread hangs if it had work at the last call and has finished nothing since. A thread without
// work is idle, for however long.
class ThreadMonitor {
 public:
  explicit ThreadMonitor(Engine* engine) : engine_(engine) {}

  // The names of the threads that hang, as in "gnss, out"; empty: none. Call it at intervals longer
  // than a thread may take for one piece of work.
  std::string stalled_threads();

 private:
  Engine* engine_;
  static constexpr std::size_t kThreads = 4;
  std::array<WorkCount, kThreads> last_{};  // ins, gnss, smoother, out
  std::int64_t last_io_rounds_ = -1;
};

}  // namespace leonav
