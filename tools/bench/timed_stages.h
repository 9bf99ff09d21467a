// The navigator's stages run in one thread with a stopwatch on each.
#pragma once
#include <chrono>
#include <vector>

#include "core/navigator/gnss_stage.h"
#include "core/navigator/inertial_navigator.h"
#include "core/navigator/sequencer.h"

namespace leonav {

// Takes outputs and forgets them: the bench times the navigator, not the disk.
class NullSink final : public OutputSink {
 public:
  void on_solution(const Solution&) override { ++solutions; }
  void on_epoch(const EpochReport& report) override {
    ++epochs;
    satellites += static_cast<std::uint64_t>(report.satellites_used);
  }
  void on_event(const Event&) override {}
  void on_decision(const Decision&) override {}
  std::uint64_t solutions = 0, epochs = 0, satellites = 0;
};

class TimedStages final : private StageInputs {
 public:
  explicit TimedStages(const NavigatorConfig& config)
      : inertial_(config, &mailbox_, &sink_),
        gnss_(config, &mailbox_, &sink_),
        sequencer_(config, this) {}

  Sequencer* sequencer() { return &sequencer_; }
  const NullSink& sink() const { return sink_; }

  std::vector<double>
      imu_sample_us;  // one inertial tick, commits with their re-propagation included
  std::vector<double> gnss_epoch_ms;  // preprocessing, prediction over the block, update, report

 private:
  using Clock = std::chrono::steady_clock;
  static double since_us(Clock::time_point start) {
    return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
  }
  void open_epoch(std::uint64_t index) override { mailbox_.open(index); }
  void push_inertial(const InertialWork& work) override {
    const Clock::time_point start = Clock::now();
    inertial_.process(work);
    if (std::holds_alternative<ImuSample>(work)) imu_sample_us.push_back(since_us(start));
  }
  void push_gnss(const GnssWork& work) override {
    const Clock::time_point start = Clock::now();
    gnss_.process(work);
    if (std::holds_alternative<EpochWork>(work)) gnss_epoch_ms.push_back(since_us(start) * 1e-3);
  }
  void event(const Event&) override {}

  NullSink sink_;
  TimedMailbox<EkfUpdate> mailbox_;
  InertialNavigator inertial_;
  GnssStage gnss_;
  Sequencer sequencer_;
};

}  // namespace leonav
