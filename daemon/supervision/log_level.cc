#include "daemon/supervision/log_level.h"

#include <spdlog/spdlog.h>

namespace leonav {

void set_log_level(LogLevel level) {
  spdlog::set_level(level == LogLevel::kError     ? spdlog::level::err
                    : level == LogLevel::kWarning ? spdlog::level::warn
                                                  : spdlog::level::info);
}

}  // namespace leonav
