// Which of the engine's threads hang: what decides whether the watchdog is fed.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "daemon/engine.h"

namespace leonav {

// A thread hangs if it had work at the last look and has finished nothing since. One without work
// is idle, for however long; work that comes at the very moment of a look is not held against it.
class ThreadWatch {
 public:
  explicit ThreadWatch(Engine* engine) : engine_(engine) {}

  // The names of those that hang, as in "gnss, out"; empty: none. Call it at intervals longer than
  // what a thread may take for one piece of work.
  std::string hanging();

 private:
  Engine* engine_;
  static constexpr std::size_t kThreads = 4;
  std::array<WorkCount, kThreads> last_{};  // ins, gnss, smoother, out
  std::int64_t last_io_rounds_ = -1;
};

}  // namespace leonav
