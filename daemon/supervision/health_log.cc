#include "daemon/supervision/health_log.h"

#include <spdlog/spdlog.h>

namespace leonav {

void HealthLog::look(HealthMonitor* health, const std::string& stalled_threads, bool stands_still) {
  const HealthStatus status = health->status();
  const std::string& why = health->why();
  if (status != status_ || why != why_ || is_first_)
    spdlog::info("{}{}{}", to_string(status), why.empty() ? "" : ": ", why);
  is_first_ = false;
  status_ = status;
  why_ = why;
  if (health->suspicions() != suspicions_)
    spdlog::warn("not as it should be: {}", health->suspicions());
  suspicions_ = health->suspicions();
  if (stands_still && !stands_still_) spdlog::error("no answer for a minute, though inputs come");
  stands_still_ = stands_still;
  if (!stalled_threads.empty() && stalled_threads != stalled_threads_)
    spdlog::error("thread hangs: {}", stalled_threads);
  stalled_threads_ = stalled_threads;
}

}  // namespace leonav
