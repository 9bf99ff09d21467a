#include "daemon/supervision/checkpoint_log.h"

#include <spdlog/spdlog.h>

#include "daemon/text/checkpoint_text.h"

namespace leonav {
namespace {

void report(const Gauge& use_gauge, const Gauge& milli, Changed<std::int64_t>* reported) {
  const std::int64_t use = use_gauge.get();
  if (!reported->look(use) || use == 0) return;
  const auto what = static_cast<CheckpointUse>(use - 1);
  const bool ignored = what != CheckpointUse::kUsed && what != CheckpointUse::kNotNeeded &&
                       what != CheckpointUse::kCalibrationUsed;
  spdlog::log(ignored ? spdlog::level::warn : spdlog::level::info, "{}",
              checkpoint_text(what, static_cast<double>(milli.get()) * 1e-3));
}

}  // namespace

void CheckpointLog::look() {
  const EngineCounters& counters = engine_->counters();
  report(counters.checkpoint_use, counters.checkpoint_milli, &use_);
  report(counters.calibration_use, counters.calibration_milli, &calibration_use_);
  const std::string error = engine_->checkpoint_error();
  if (error_.look(error) && !error.empty()) spdlog::warn("no checkpoint: {}", error);
}

}  // namespace leonav
