#include "daemon/supervision/health_log.h"

#include <spdlog/spdlog.h>

namespace leonav {
namespace {

spdlog::level::level_enum level_of(HealthStatus status) {
  switch (status) {
    case HealthStatus::kOk:
      return spdlog::level::info;
    case HealthStatus::kDegraded:
      return spdlog::level::warn;
    case HealthStatus::kFault:
      return spdlog::level::err;
  }
  return spdlog::level::err;
}

}  // namespace

void HealthLog::look(HealthMonitor* health, const std::string& stalled_threads, bool stands_still) {
  const std::string& why = health->why();
  const bool is_other_status = status_.look(health->status()), is_other_why = why_.look(why);
  if (is_other_status || is_other_why)
    spdlog::log(level_of(health->status()), "{}{}{}", to_string(health->status()),
                why.empty() ? "" : ": ", why);
  if (suspicions_.look(health->suspicions()))
    spdlog::warn("not as it should be: {}", health->suspicions());
  if (stands_still_.look(stands_still) && stands_still)
    spdlog::error("the answer stands still, though inputs come");
  if (stalled_threads_.look(stalled_threads) && !stalled_threads.empty())
    spdlog::error("thread hangs: {}", stalled_threads);
}

}  // namespace leonav
