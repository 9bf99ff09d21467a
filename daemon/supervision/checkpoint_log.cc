#include "daemon/supervision/checkpoint_log.h"

#include <spdlog/spdlog.h>

#include "daemon/text/checkpoint_text.h"

namespace leonav {
namespace {

// `last` is the use that was reported; 0: there was none yet.
void report(const Gauge& use_gauge, const Gauge& milli, std::int64_t* last) {
  const std::int64_t use = use_gauge.get();
  if (use != 0 && use != *last) {
    const auto what = static_cast<CheckpointUse>(use - 1);
    const bool ignored = what != CheckpointUse::kUsed && what != CheckpointUse::kNotNeeded &&
                         what != CheckpointUse::kCalibrationUsed;
    spdlog::log(ignored ? spdlog::level::warn : spdlog::level::info, "{}",
                checkpoint_text(what, static_cast<double>(milli.get()) * 1e-3));
  }
  *last = use;
}

}  // namespace

void CheckpointLog::look() {
  const EngineCounters& counters = engine_->counters();
  report(counters.checkpoint_use, counters.checkpoint_milli, &last_use_);
  report(counters.calibration_use, counters.calibration_milli, &last_calibration_use_);
  const std::string error = engine_->checkpoint_error();
  if (!error.empty() && error != last_error_) spdlog::warn("no checkpoint: {}", error);
  last_error_ = error;
}

}  // namespace leonav
