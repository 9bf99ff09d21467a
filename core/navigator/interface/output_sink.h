// OutputSink receives every output of the navigator, in order.
#pragma once
#include "core/navigator/interface/decision.h"
#include "core/navigator/interface/epoch_report.h"
#include "core/navigator/interface/event.h"
#include "core/navigator/interface/smoother_report.h"
#include "core/navigator/interface/solution.h"

namespace leonav {

// The interface that a program implements to receive outputs. In the daemon each stage calls it
// from its own thread. A call must not block for long and must not throw.
class OutputSink {
 public:
  virtual ~OutputSink() = default;
  virtual void on_solution(const Solution& solution) = 0;
  virtual void on_epoch(const EpochReport& report) = 0;
  virtual void on_event(const Event& event) = 0;
  virtual void on_decision(const Decision& decision) = 0;
  virtual void on_smoother(const SmootherReport& report) = 0;
};

}  // namespace leonav
