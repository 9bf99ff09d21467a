#include "daemon/threads/realtime_thread.h"

#include <unistd.h>

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include "daemon/threads/process_threads.h"

namespace leonav {

std::string RealtimeThread::start(const std::string& name, const ThreadConfig& config,
                                  std::function<void()> body, std::size_t stack_bytes) {
  body_ = std::move(body);
  name_ = "leonav-" + name;
  id_ = 0;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, stack_bytes);
  const auto entry = [](void* self) -> void* {
    auto* thread = static_cast<RealtimeThread*>(self);
    pthread_setname_np(pthread_self(), thread->name_.c_str());
    thread->id_ = gettid();
    thread->id_.notify_one();
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
  id_.wait(0);
  return schedule(id_, name, config);
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
