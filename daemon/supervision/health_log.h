// The HealthLog logs the changes of HEALTH, of threads that hang and of an answer that stands
// still.
#pragma once
#include <optional>
#include <string>

#include "daemon/health/health_monitor.h"
#include "daemon/supervision/changed.h"

namespace leonav {

class HealthLog {
 public:
  // Once a second, after the monitor's next().
  void look(HealthMonitor* health, const std::string& stalled_threads, bool stands_still);

 private:
  Changed<std::optional<HealthStatus>> status_;
  Changed<std::string> why_, suspicions_, stalled_threads_;
  Changed<bool> stands_still_;
};

}  // namespace leonav
