// A RealtimeThread has a stack of fixed size and, where the system allows it, real-time priority.
#pragma once
#include <pthread.h>

#include <functional>
#include <string>

#include "daemon/config/daemon_config.h"

namespace leonav {

class RealtimeThread {
 public:
  RealtimeThread() = default;
  ~RealtimeThread() { join(); }
  RealtimeThread(const RealtimeThread&) = delete;
  RealtimeThread& operator=(const RealtimeThread&) = delete;

  // Throws std::runtime_error if no thread can be made. Returns the settings of `config` that the
  // system refused, as a text; empty: none.
  std::string start(const std::string& name, const ThreadConfig& config, std::function<void()> body,
                    std::size_t stack_bytes = kStackBytes);
  void join();
  // Leaves the thread to itself. This object must then live as long as the thread.
  void detach();

  // Locked memory counts whole stacks, so they are no larger than they must be; the GNSS stage
  // keeps matrices of some hundred kilobytes on its own.
  static constexpr std::size_t kStackBytes = 4U << 20;

 private:
  std::function<void()> body_;
  std::string name_;
  pthread_t thread_{};
  bool running_ = false;
};

}  // namespace leonav
