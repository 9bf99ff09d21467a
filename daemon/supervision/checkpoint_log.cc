#include "daemon/supervision/checkpoint_log.h"

#include <spdlog/spdlog.h>

#include "daemon/text/checkpoint_text.h"

namespace leonav {

void CheckpointLog::look() {
  const EngineCounters& counters = engine_->counters();
  const std::int64_t use = counters.checkpoint_use.get();
  if (use != 0 && use != last_use_) {
    const auto what = static_cast<CheckpointUse>(use - 1);
    const double value = static_cast<double>(counters.checkpoint_milli.get()) * 1e-3;
    const bool ignored = what != CheckpointUse::kUsed && what != CheckpointUse::kNotNeeded;
    spdlog::log(ignored ? spdlog::level::warn : spdlog::level::info, "{}",
                checkpoint_text(what, value));
  }
  last_use_ = use;
  const std::string error = engine_->checkpoint_error();
  if (!error.empty() && error != last_error_) spdlog::warn("no checkpoint: {}", error);
  last_error_ = error;
}

}  // namespace leonav
