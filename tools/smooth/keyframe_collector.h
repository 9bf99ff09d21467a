// KeyframeCollector runs the filter over a log and keeps every keyframe in a LogGraph.
#pragma once
#include <functional>
#include <memory>
#include <utility>

#include "core/navigator/interface/output_sink.h"
#include "core/navigator/interface/timed_mailbox.h"
#include "core/navigator/sequencer/sequencer.h"
#include "core/navigator/stages/gnss_stage.h"
#include "core/smoother/batch/log_graph.h"
#include "daemon/messages/input_dispatch.h"

namespace leonav {

// Counts of a pass of the filter.
struct PassCounts {
  long epochs = 0, resets = 0;
};

// KeyframeCollector is fed with a log's messages. Nothing is late: it works in the caller's thread.
class KeyframeCollector final : private StageInputs, private KeyframeSink, private OutputSink {
 public:
  // `graph` must outlive the collector. `observe` gets the report of every epoch.
  KeyframeCollector(
      const NavigatorConfig& config, LogGraph* graph,
      std::function<void(const EpochReport&)> observe = [](const EpochReport&) {})
      : graph_(graph),
        observe_(std::move(observe)),
        keyframe_(std::make_unique<KeyframeInput>()),
        gnss_(config, &mailbox_, this, this),
        sequencer_(config, this),
        dispatch_(&sequencer_) {}

  void dispatch(Channel channel, ByteSpan data) { dispatch_.dispatch(channel, data); }
  const PassCounts& counts() const { return counts_; }

 private:
  void open_epoch(std::uint64_t index) override { mailbox_.open(index); }
  void push_inertial(const InertialWork&) override {}
  void push_gnss(const GnssWork& work) override { gnss_.process(work); }
  void event(const Event&) override {}
  KeyframeInput* next_keyframe(std::uint64_t) override { return keyframe_.get(); }
  void push_keyframe() override { graph_->add(*keyframe_); }
  void no_keyframe(const Solution&, bool) override {}
  bool result_of(std::uint64_t, SmootherAnchor*) override { return false; }
  void on_solution(const Solution&) override {}
  void on_epoch(const EpochReport& report) override {
    ++counts_.epochs;
    observe_(report);
  }
  void on_event(const Event& event) override {
    counts_.resets += event.kind == EventKind::kFilterReset ? 1 : 0;
  }
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport&) override {}

  LogGraph* graph_;
  std::function<void(const EpochReport&)> observe_;
  PassCounts counts_;
  TimedMailbox<Anchor> mailbox_;
  std::unique_ptr<KeyframeInput> keyframe_;
  GnssStage gnss_;
  Sequencer sequencer_;
  InputDispatch dispatch_;
};

}  // namespace leonav
