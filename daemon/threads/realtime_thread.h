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
  std::string start(const std::string& name, const ThreadConfig& config,
                    std::function<void()> body);
  void join();

 private:
  std::function<void()> body_;
  std::string name_;
  pthread_t thread_{};
  bool running_ = false;
};

}  // namespace leonav
