// The SolutionMonitor finds an answer that is missing, late, not yet aligned or without GNSS.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/solution.h"
#include "daemon/health/internal/estimator_monitor.h"
#include "daemon/health/internal/findings.h"
#include "daemon/health/internal/input_monitor.h"
#include "daemon/health/internal/level_test.h"
#include "daemon/health/internal/sign_of_life.h"
#include "daemon/health/keep_rule.h"
#include "daemon/threads/counters.h"

namespace leonav {

// The monitors of inputs and estimator, which must have looked before, know why there is none.
class SolutionMonitor {
 public:
  SolutionMonitor(const EngineCounters* counters, const NavigatorConfig& config);

  // Once a second; valid until the next call.
  std::span<const Finding> look(double now_s, InputMonitor* inputs,
                                const EstimatorMonitor& estimator);
  // The lack of an answer at the last look.
  Fault fault() const { return fault_; }
  // The source of the answer; kNone: it has ended, or there was none yet.
  Source source() const;

 private:
  // Returns what the first position waits for. Valid until the next call.
  std::string_view why_no_solution(InputMonitor* inputs, const EstimatorMonitor& estimator);

  const EngineCounters* counters_;
  AlignmentConfig alignment_;
  bool expects_imu_;
  SignOfLife solution_;
  SignOfLife solution_without_imu_;  // the same answer, where it comes once an epoch
  bool has_ended_ = false;           // at the last look
  LevelTest levels_;
  Fault fault_ = Fault::kNone;
  std::string detail_;  // of the reason that is looked at
  Findings found_;
};

}  // namespace leonav
