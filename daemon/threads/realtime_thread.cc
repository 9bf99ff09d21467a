#include "daemon/threads/realtime_thread.h"

#include <sched.h>

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

namespace leonav {
std::string RealtimeThread::start(const std::string& name, const ThreadConfig& config,
                                  std::function<void()> body, std::size_t stack_bytes) {
  body_ = std::move(body);
  name_ = "leonav-" + name;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, stack_bytes);
  const auto entry = [](void* self) -> void* {
    auto* thread = static_cast<RealtimeThread*>(self);
    pthread_setname_np(pthread_self(), thread->name_.c_str());
    thread->body_();
    return nullptr;
  };
  const int failure = pthread_create(&thread_, &attributes, entry, this);
  pthread_attr_destroy(&attributes);
  if (failure != 0) {
    throw std::runtime_error("cannot start thread " + name + ": " + std::strerror(failure) +
                             "; give it more memory or threads (MemoryMax= and TasksMax= of its "
                             "unit, ulimit -v and -u)");
  }
  running_ = true;
  std::string refused;
  if (config.priority > 0) {
    sched_param parameters{};
    parameters.sched_priority = config.priority;
    if (const int error = pthread_setschedparam(thread_, SCHED_FIFO, &parameters)) {
      refused += "thread " + name + ": no SCHED_FIFO priority: " + std::strerror(error);
    }
  }
  if (config.cpu >= 0) {
    cpu_set_t cpus;
    CPU_ZERO(&cpus);
    CPU_SET(static_cast<unsigned>(config.cpu), &cpus);
    if (const int error = pthread_setaffinity_np(thread_, sizeof cpus, &cpus)) {
      refused += (refused.empty() ? "thread " : "; thread ") + name + ": not pinned to processor " +
                 std::to_string(config.cpu) + ": " + std::strerror(error);
    }
  }
  return refused;
}

void RealtimeThread::join() {
  if (!running_) return;
  pthread_join(thread_, nullptr);
  running_ = false;
}

bool RealtimeThread::join_or_detach(double longest_s, const std::function<bool()>& has_ended) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(longest_s);
  while (!has_ended() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (!running_ || has_ended()) {
    join();
    return true;
  }
  pthread_detach(thread_);
  running_ = false;
  return false;
}

}  // namespace leonav
