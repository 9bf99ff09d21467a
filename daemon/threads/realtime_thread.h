// A RealtimeThread has a stack of fixed size and, where the system allows it, real-time priority.
#pragma once
#include <pthread.h>
#include <sys/types.h>

#include <atomic>
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
  // Joins the thread once `has_ended` holds, or detaches it after so long: a disk or a reader may
  // hold it. Returns whether it was joined; if not, this object must live as long as the thread
  // (leave_to_process.h).
  bool join_or_detach(double longest_s, const std::function<bool()>& has_ended);

  // Locked memory counts whole stacks, so they are no larger than they must be: some twice what is
  // used (docs/validation/service.md). The estimators keep matrices of some hundred kilobytes on
  // theirs, `io` an epoch. Those that only pass values or bytes on have small ones.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  static constexpr std::size_t kStackScale = 4;
#elif !defined(__OPTIMIZE__)
  static constexpr std::size_t kStackScale = 2;
#else
  static constexpr std::size_t kStackScale = 1;
#endif
  static constexpr std::size_t kStackBytes = kStackScale * (512 << 10);
  static constexpr std::size_t kSmallStackBytes = kStackScale * (256 << 10);
  static constexpr std::size_t kEstimatorStackBytes = kStackScale * (1536 << 10);
  // Larger than what glibc would reuse for a thread with kStackBytes: four times that.
  static constexpr std::size_t kLargestStackBytes = kStackScale * (2304 << 10);

 private:
  std::function<void()> body_;
  std::string name_;
  pthread_t thread_{};
  std::atomic<pid_t> id_{0};  // that of the system; 0: the thread has not begun
  bool running_ = false;
};

}  // namespace leonav
