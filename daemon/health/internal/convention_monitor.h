// The ConventionMonitor finds inputs that break a convention.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "daemon/health/internal/findings.h"
#include "daemon/threads/counters.h"

namespace leonav {

// A mistake in the configuration or in what feeds the daemon. The reason stays until the mistake is
// mended and the daemon is started again.
class ConventionMonitor {
 public:
  explicit ConventionMonitor(const EngineCounters* counters) : counters_(counters) {}

  // Once a second; valid until the next call.
  std::span<const Finding> look();
  // Each with its remedy; empty: none.
  const std::string& suspicions() const { return suspicions_; }

 private:
  const EngineCounters* counters_;
  std::string suspicions_;
  // The values that suspicions_ tells, in thousandths.
  std::array<std::optional<std::int64_t>, kConventionCount> suspected_;
  Findings found_;
};

}  // namespace leonav
