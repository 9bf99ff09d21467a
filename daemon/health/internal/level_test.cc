#include "daemon/health/internal/level_test.h"

#include <cstdio>

#include "daemon/health/internal/findings.h"

namespace leonav {
namespace {

constexpr std::size_t kExceededBytes = 256;  // of what a run meets; no limit

}  // namespace

LevelTest::LevelTest(const IntegrityConfig& config)
    : horizontal_alert_limit_m_(config.horizontal_alert_limit_m),
      vertical_alert_limit_m_(config.vertical_alert_limit_m) {
  exceeded_.reserve(kExceededBytes);
}

std::string_view LevelTest::exceeded(const EngineCounters& counters) {
  exceeded_.clear();
  compare("horizontal", counters.horizontal_protection_micro, horizontal_alert_limit_m_);
  compare("vertical", counters.vertical_protection_micro, vertical_alert_limit_m_);
  return exceeded_;
}

void LevelTest::compare(std::string_view name, const Gauge& level, double limit_m) {
  if (limit_m == 0.0) return;
  const std::int64_t micro = level.get();
  if (micro >= 0 && static_cast<double>(micro) * 1e-6 <= limit_m) return;
  append_to_list(name, &exceeded_);
  if (micro < 0) {
    exceeded_ += " unknown";
    return;
  }
  char limit[64];
  std::snprintf(limit, sizeof limit, " above its alert limit of %.2f m", limit_m);
  exceeded_ += limit;
}

}  // namespace leonav
