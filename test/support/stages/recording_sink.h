// An OutputSink that keeps everything.
#pragma once
#include <vector>

#include "core/navigator/interface/output_sink.h"

namespace leonav::test {

// What a journal says of an epoch.
inline Decision decided(std::uint64_t epoch, Decision::Subject subject, bool committed,
                        int iterations = 0) {
  Decision decision;
  decision.epoch = epoch;
  decision.subject = subject;
  decision.committed = committed;
  decision.iterations = iterations;
  return decision;
}

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
