// The stages run in one thread: replay, tests, tools.
#pragma once
#include <cstdint>
#include <map>
#include <memory>

#include "core/navigator/gnss_stage.h"
#include "core/navigator/inertial_navigator.h"
#include "core/navigator/sequencer.h"
#include "core/navigator/smoother_stage.h"

namespace leonav {

// Feed inputs in order through sequencer(); outputs go to the sink. Without recorded decisions
// every result is in time.
class Pipeline final : private StageInputs, private KeyframeSink, private SolveBudget {
 public:
  Pipeline(const NavigatorConfig& config, OutputSink* sink);

  // Call before feeding, for every decision of the journal. Epochs whose decision is not there are
  // in time.
  void record(const Decision& decision);

  Sequencer& sequencer() { return sequencer_; }
  const Sequencer& sequencer() const { return sequencer_; }
  const GnssStage& gnss() const { return gnss_; }
  const InertialNavigator& inertial() const { return inertial_; }
  const SmootherStage* smoother() const { return smoother_.get(); }

 private:
  void open_epoch(std::uint64_t index) override;
  void push_inertial(const InertialWork& work) override;
  void push_gnss(const GnssWork& work) override;
  void event(const Event& event) override;
  KeyframeInput* next_keyframe(std::uint64_t epoch) override;
  void push_keyframe() override;
  void no_keyframe(const Solution& filter, bool due) override;
  bool may_iterate(int iterations_done) override;

  // What became of one epoch when this was recorded.
  struct Recorded {
    bool ekf_missed = false, smoother_missed = false, keyframe_skipped = false;
    int iterations = -1;  // the smoother's; -1: not recorded
  };
  OutputSink* sink_;
  std::map<std::uint64_t, Recorded> recorded_;
  int iterations_allowed_ = -1;  // of the solve at hand; -1: as many as it likes
  TimedMailbox<EkfUpdate> ekf_mailbox_;
  TimedMailbox<SmootherUpdate> smoother_mailbox_;
  std::unique_ptr<KeyframeInput> keyframe_;
  std::unique_ptr<SmootherStage> smoother_;  // nullptr: the filter gives the answer
  InertialNavigator inertial_;
  GnssStage gnss_;
  Sequencer sequencer_;
};

}  // namespace leonav
