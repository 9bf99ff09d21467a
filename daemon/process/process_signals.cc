#include "daemon/process/process_signals.h"

#include <pthread.h>

#include <array>
#include <ctime>

#include "core/base/gps_time.h"
#include "daemon/threads/wall_clock.h"

namespace leonav {
namespace {

constexpr std::array kSignals = {SIGTERM, SIGINT, SIGHUP};

pthread_t main_thread;

// Libraries may have threads that were there before main() and block nothing. A signal that the
// kernel gives to one of them goes on to the main thread.
extern "C" void pass_to_main_thread(int signal) { pthread_kill(main_thread, signal); }

}  // namespace

ProcessSignals::ProcessSignals() {
  sigemptyset(&set_);
  main_thread = pthread_self();
  for (const int signal : kSignals) sigaddset(&set_, signal);
  pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  for (const int signal : kSignals) std::signal(signal, pass_to_main_thread);
}

ProcessSignals::~ProcessSignals() {
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGHUP, SIG_IGN);
  // A request may come twice at a time: timeout of coreutils sends to the process and to its group.
  const timespec now{};
  while (sigtimedwait(&set_, nullptr, &now) > 0) {
  }
  pthread_sigmask(SIG_UNBLOCK, &set_, nullptr);
}

SignalRequest ProcessSignals::wait_until(std::int64_t until_ns) {
  for (;;) {
    const std::int64_t left_ns = until_ns - monotonic_ns();
    if (left_ns <= 0) return SignalRequest::kNone;
    const timespec left{left_ns / kNanosecondsPerSecond, left_ns % kNanosecondsPerSecond};
    last_ = sigtimedwait(&set_, nullptr, &left);
    if (last_ == SIGHUP) return SignalRequest::kReload;
    if (last_ > 0) return SignalRequest::kStop;
  }
}

}  // namespace leonav
