// A thread with a stack of stated size and, where the system allows it, real-time scheduling.
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

  // Throws std::runtime_error if no thread can be made. What the system refuses of `config` comes
  // back in words; empty: nothing.
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
