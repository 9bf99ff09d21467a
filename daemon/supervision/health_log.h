// The HealthLog logs the changes of HEALTH, of threads that hang and of an answer that stands
// still.
#pragma once
#include <string>

#include "daemon/health/health_monitor.h"

namespace leonav {

class HealthLog {
 public:
  // Once a second, after the monitor's next().
  void look(HealthMonitor* health, const std::string& stalled_threads, bool stands_still);

 private:
  bool is_first_ = true;
  HealthStatus status_ = HealthStatus::kOk;
  std::string why_, suspicions_, stalled_threads_;
  bool stands_still_ = false;
};

}  // namespace leonav
