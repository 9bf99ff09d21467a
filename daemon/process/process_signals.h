// ProcessSignals takes the signals that are meant for the daemon, in the thread `main`.
#pragma once
#include <csignal>
#include <cstdint>

namespace leonav {

enum class SignalRequest : unsigned char {
  kNone,
  kStop,    // SIGTERM, SIGINT
  kReload,  // SIGHUP
};

// From construction on they are blocked in this thread and in all that it starts. Whatever ends the
// object's life, the next SIGTERM or SIGINT then ends the process at once, even where its end
// hangs; SIGHUP is ignored.
class ProcessSignals {
 public:
  ProcessSignals();
  ~ProcessSignals();
  ProcessSignals(const ProcessSignals&) = delete;
  ProcessSignals& operator=(const ProcessSignals&) = delete;

  // Waits for the next one, until a time of monotonic_ns() at most.
  SignalRequest wait_until(std::int64_t until_ns);
  // After kStop: its name.
  const char* name() const { return last_ == SIGINT ? "SIGINT" : "SIGTERM"; }

 private:
  sigset_t set_;
  int last_ = 0;
};

}  // namespace leonav
