// An OutputSink that keeps everything.
#pragma once
#include <vector>

#include "core/navigator/outputs.h"

namespace leonav::test {

struct RecordingSink : OutputSink {
  std::vector<Solution> solutions;
  std::vector<EpochReport> epochs;
  std::vector<Event> events;
  std::vector<Decision> decisions;
  std::vector<SmootherReport> smoothed;

  void on_solution(const Solution& solution) override { solutions.push_back(solution); }
  void on_epoch(const EpochReport& report) override { epochs.push_back(report); }
  void on_event(const Event& event) override { events.push_back(event); }
  void on_decision(const Decision& decision) override { decisions.push_back(decision); }
  void on_smoother(const SmootherReport& report) override { smoothed.push_back(report); }

  std::size_t count(EventKind kind) const {
    std::size_t n = 0;
    for (const Event& event : events) n += event.kind == kind ? 1 : 0;
    return n;
  }
};

}  // namespace leonav::test
