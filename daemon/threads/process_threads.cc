#include "daemon/threads/process_threads.h"

#include <sched.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>

namespace leonav {

std::set<pid_t> threads_of_process() {
  std::set<pid_t> threads;
  std::error_code error;
  for (std::filesystem::directory_iterator entry("/proc/self/task", error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    pid_t thread = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), thread).ec == std::errc())
      threads.insert(thread);
  }
  return threads;
}

std::string schedule(pid_t thread, const std::string& name, const ThreadConfig& config) {
  std::string refused;
  if (config.cpu >= 0) {
    cpu_set_t cpus;
    CPU_ZERO(&cpus);
    if (config.cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(config.cpu), &cpus);
    if (sched_setaffinity(thread, sizeof cpus, &cpus) != 0)
      refused = "thread " + name + ": not pinned to processor " + std::to_string(config.cpu) +
                ": " + std::strerror(errno);
  }
  if (config.priority <= 0) return refused;
  sched_param parameters{};
  parameters.sched_priority = config.priority;
  if (sched_setscheduler(thread, SCHED_FIFO, &parameters) == 0) return refused;
  return refused + (refused.empty() ? "" : "; ") + "thread " + name +
         ": no SCHED_FIFO priority: " + std::strerror(errno);
}

}  // namespace leonav
