// TimedStages runs the navigator's stages in one thread with a stopwatch on each.
#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "core/navigator/sequencer/sequencer.h"
#include "core/navigator/stages/gnss_stage.h"
#include "core/navigator/stages/inertial_navigator.h"
#include "core/navigator/stages/smoother_stage.h"
#include "tools/bench/stopwatch.h"
#include "tools/common/allocations/allocation_counter.h"

namespace leonav {

// CountingSink counts outputs and writes nothing: the bench measures the navigator, not the disk.
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
  void on_smoother(const SmootherReport& report) override {
    iterations.push_back(report.iterations);
    keyframes = std::max(keyframes, report.keyframes);
  }

  std::vector<int> satellites;  // used, of each epoch
  std::vector<int> iterations;  // of each solve
  int keyframes = 0;            // largest number in a window
  std::uint64_t solutions = 0, carriers = 0, slips = 0;
};

// TimedStages is fed through its Sequencer and measures every call of a stage.
class TimedStages final : private StageInputs, private KeyframeSink, private SolveBudget {
 public:
  explicit TimedStages(const NavigatorConfig& config)
      : keyframe_(std::make_unique<KeyframeInput>()),
        smoother_(config.estimator == Estimator::kSmoother
                      ? std::make_unique<SmootherStage>(config, &smoother_mailbox_, &sink_)
                      : nullptr),
        inertial_(config, &mailbox_, &smoother_mailbox_, &sink_),
        gnss_(config, &mailbox_, smoother_ != nullptr ? this : nullptr, &sink_),
        sequencer_(config, this) {}

  // Reserves memory for the durations of some hours; call it before the first message.
  void reserve() {
    for (Times* times : {&imu_sample, &gnss_epoch, &solve}) times->reserve(1 << 20);
    sink_.satellites.reserve(1 << 20);
    sink_.iterations.reserve(1 << 20);
  }
  // Deletes all durations, but keeps their memory.
  void forget() {
    for (Times* times : {&imu_sample, &gnss_epoch, &solve}) times->clear();
    sink_.satellites.clear();
    sink_.iterations.clear();
  }
  const Window* window() const {
    return smoother_ != nullptr ? &smoother_->smoother().window() : nullptr;
  }

  Sequencer* sequencer() { return &sequencer_; }
  const CountingSink& sink() const { return sink_; }

  Times imu_sample;  // one inertial tick, including commits and propagation from a new anchor
  Times gnss_epoch;  // prediction over the block, preprocessing, slip tests, update, report
  Times solve;       // a keyframe into the window, all iterations, process factors and prior
  std::size_t solve_allocations = 0;

 private:
  void open_epoch(std::uint64_t index) override {
    mailbox_.open(index);
    smoother_mailbox_.open(index);
  }
  void push_inertial(const InertialWork& work) override {
    const Stopwatch watch;
    inertial_.process(work);
    if (std::holds_alternative<ImuSample>(work)) watch.stop(&imu_sample);
  }
  void push_gnss(const GnssWork& work) override {
    const Stopwatch watch;
    gnss_.process(work);
    if (std::holds_alternative<EpochWork>(work)) watch.stop(&gnss_epoch);
    if (has_keyframe_) solve_keyframe();
  }
  void solve_keyframe() {
    has_keyframe_ = false;
    start_counting_allocations();
    const Stopwatch watch;
    smoother_->process(*keyframe_, this);
    solve_allocations += stop_counting_allocations();
    watch.stop(&solve);
  }
  KeyframeInput* next_keyframe(std::uint64_t) override { return keyframe_.get(); }
  // deferred, so that the filter's time is its own
  void push_keyframe() override { has_keyframe_ = true; }
  void no_keyframe(const Solution& filter, bool due) override {
    smoother_->process_non_keyframe(filter, due);
  }
  bool result_of(std::uint64_t epoch, SmootherAnchor* result) override {
    return smoother_mailbox_.read(epoch, result);
  }
  bool may_iterate(int) override { return true; }
  void event(const Event&) override {}

  CountingSink sink_;
  TimedMailbox<Anchor> mailbox_;
  TimedMailbox<SmootherAnchor> smoother_mailbox_;
  std::unique_ptr<KeyframeInput> keyframe_;
  bool has_keyframe_ = false;
  std::unique_ptr<SmootherStage> smoother_;  // nullptr: the filter gives the answer
  InertialNavigator inertial_;
  GnssStage gnss_;
  Sequencer sequencer_;
};

}  // namespace leonav
