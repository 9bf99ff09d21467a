// The HEALTH message reports the daemon's status and the engine's counters.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/navigator/interface/solution.h"
#include "daemon/engine/engine.h"
#include "daemon/health/health_reason.h"

namespace leonav {

// The result of the HealthMonitor's evaluation.
struct HealthSummary {
  std::uint64_t sequence = 0;
  HealthStatus status = HealthStatus::kOk;
  std::string_view why;
  Source source = Source::kNone;
  double uptime_s = 0.0;
};

// Memory is taken at construction, and again only where a text is longer than any before.
class HealthMessage {
 public:
  HealthMessage();
  ~HealthMessage();
  HealthMessage(const HealthMessage&) = delete;
  HealthMessage& operator=(const HealthMessage&) = delete;

  // Encodes the summary with the engine's counters; valid until the next call. The counters of
  // worst durations are read and cleared: each message holds those since the message before it.
  std::span<const std::uint8_t> encode(const HealthSummary& summary, Engine* engine);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace leonav
