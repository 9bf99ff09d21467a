// The HEALTH message reports the daemon's status and the engine's counters.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/navigator/interface/solution.h"
#include "daemon/engine/engine.h"
#include "daemon/health/health_reason.h"

namespace leonav {

// The result of the HealthMonitor's evaluation.
struct HealthSummary {
  std::uint64_t sequence = 0;
  HealthStatus status = HealthStatus::kOk;
  std::string why;
  Source source = Source::kNone;
  double uptime_s = 0.0;
};

// Encodes the summary with the engine's counters. The counters of worst durations are read and
// cleared: each message holds those since the message before it.
void encode_health(const HealthSummary& summary, Engine* engine, std::vector<std::uint8_t>* bytes);

}  // namespace leonav
