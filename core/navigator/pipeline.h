// The stages run in one thread: replay, tests, tools.
#pragma once
#include <cstdint>
#include <map>
#include <memory>

#include "core/navigator/gnss_stage.h"
#include "core/navigator/inertial_navigator.h"
#include "core/navigator/sequencer.h"

namespace leonav {

// Feed inputs in order through sequencer(); outputs go to the sink. Without recorded decisions
// every result is in time.
class Pipeline final : private StageInputs {
 public:
  Pipeline(const NavigatorConfig& config, OutputSink* sink);

  // Call before feeding: epoch's EKF result missed its deadline when this was recorded.
  void record_miss(std::uint64_t epoch);

  Sequencer& sequencer() { return sequencer_; }
  const Sequencer& sequencer() const { return sequencer_; }
  const GnssStage& gnss() const { return gnss_; }
  const InertialNavigator& inertial() const { return inertial_; }

 private:
  void open_epoch(std::uint64_t index) override;
  void push_inertial(const InertialWork& work) override;
  void push_gnss(const GnssWork& work) override;
  void event(const Event& event) override;

  OutputSink* sink_;
  std::map<std::uint64_t, bool> recorded_misses_;
  TimedMailbox<EkfUpdate> ekf_mailbox_;
  InertialNavigator inertial_;
  GnssStage gnss_;
  Sequencer sequencer_;
};

}  // namespace leonav
