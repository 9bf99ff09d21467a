// The LevelTest finds a solution that may be further off than its user allows.
#pragma once
#include <string>
#include <string_view>

#include "core/navigator/interface/navigator_config.h"
#include "daemon/threads/counters.h"

namespace leonav {

class LevelTest {
 public:
  explicit LevelTest(const IntegrityConfig& config);

  // Returns which protection levels are above their alert limits, or unknown; "": none. The levels
  // themselves are fields of HEALTH: here they would change the text, and be logged, every second.
  // Valid until the next call.
  std::string_view exceeded(const EngineCounters& counters);

 private:
  void compare(std::string_view name, const Gauge& level, double limit_m);

  double horizontal_alert_limit_m_, vertical_alert_limit_m_;  // 0: none
  std::string exceeded_;
};

}  // namespace leonav
