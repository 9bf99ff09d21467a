// The LoadMonitor finds work that is late or left out, because the machine has not the time for it.
#pragma once
#include <span>

#include "daemon/engine/engine.h"
#include "daemon/health/internal/findings.h"
#include "daemon/health/internal/growth_since_look.h"

namespace leonav {

class LoadMonitor {
 public:
  explicit LoadMonitor(Engine* engine) : engine_(engine) {}

  // Once a second; valid until the next call.
  std::span<const Finding> look();

 private:
  Engine* engine_;
  GrowthSinceLook misses_, smoother_misses_, smoother_failures_, keyframes_skipped_, waits_;
  Findings found_;
};

}  // namespace leonav
