// The navigator's stages run in one thread with a stopwatch on each.
#pragma once
#include <vector>

#include "core/navigator/gnss_stage.h"
#include "core/navigator/inertial_navigator.h"
#include "core/navigator/sequencer.h"
#include "stopwatch.h"

namespace leonav {

// Takes outputs and keeps counts: the bench times the navigator, not the disk.
class CountingSink final : public OutputSink {
 public:
  void on_solution(const Solution&) override { ++solutions; }
  void on_epoch(const EpochReport& report) override {
    satellites.push_back(report.satellites_used);
    for (const SatelliteReport& satellite : report.satellites) {
      if (satellite.arc_started && satellite.arc_causes.any()) ++slips;
    }
    for (const AidingReport& aiding : report.aiding) {
      if (aiding.observable == Observable::kCarrier && aiding.reason == Reason::kUsed) ++carriers;
    }
  }
  void on_event(const Event&) override {}
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport&) override {}

  std::vector<int> satellites;  // used, of each epoch
  std::uint64_t solutions = 0, carriers = 0, slips = 0;
};

class TimedStages final : private StageInputs {
 public:
  explicit TimedStages(const NavigatorConfig& config)
      : inertial_(config, &mailbox_, nullptr, &sink_),
        gnss_(config, &mailbox_, nullptr, &sink_),
        sequencer_(config, this) {}

  Sequencer* sequencer() { return &sequencer_; }
  const CountingSink& sink() const { return sink_; }

  Times imu_sample;  // one inertial tick, commits with their re-propagation included
  Times gnss_epoch;  // prediction over the block, preprocessing, slip checks, update, report

 private:
  void open_epoch(std::uint64_t index) override { mailbox_.open(index); }
  void push_inertial(const InertialWork& work) override {
    const Stopwatch watch;
    inertial_.process(work);
    if (std::holds_alternative<ImuSample>(work)) watch.stop(&imu_sample);
  }
  void push_gnss(const GnssWork& work) override {
    const Stopwatch watch;
    gnss_.process(work);
    if (std::holds_alternative<EpochWork>(work)) watch.stop(&gnss_epoch);
  }
  void event(const Event&) override {}

  CountingSink sink_;
  TimedMailbox<EkfUpdate> mailbox_;
  InertialNavigator inertial_;
  GnssStage gnss_;
  Sequencer sequencer_;
};

}  // namespace leonav
