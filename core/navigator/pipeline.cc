#include "core/navigator/pipeline.h"

#include <variant>

namespace leonav {

Pipeline::Pipeline(const NavigatorConfig& config, OutputSink* sink)
    : sink_(sink),
      smoother_(config.estimator == Estimator::kSmoother
                    ? std::make_unique<SmootherStage>(config, &smoother_mailbox_, sink)
                    : nullptr),
      inertial_(config, &ekf_mailbox_, &smoother_mailbox_, sink),
      gnss_(config, &ekf_mailbox_, smoother_ != nullptr ? this : nullptr, sink),
      sequencer_(config, this) {
  if (smoother_ != nullptr) keyframe_ = std::make_unique<KeyframeInput>();
}

void Pipeline::record(const Decision& decision) {
  if (decision.committed && decision.mailbox != 1) return;
  Recorded& recorded = recorded_[decision.epoch];
  if (decision.mailbox == 0) recorded.ekf_missed = true;
  if (decision.mailbox == 2) recorded.keyframe_skipped = true;
  if (decision.mailbox != 1) return;
  recorded.smoother_missed = !decision.committed;
  recorded.iterations = decision.iterations;
}

// A slot still under way makes this epoch a miss, as in the daemon.
void Pipeline::open_epoch(std::uint64_t index) {
  ekf_mailbox_.open(index);
  if (smoother_ != nullptr) smoother_mailbox_.open(index);
  const auto found = recorded_.find(index);
  if (found == recorded_.end()) return;
  if (found->second.ekf_missed) ekf_mailbox_.cancel(index);
  if (found->second.smoother_missed) smoother_mailbox_.cancel(index);
}

KeyframeInput* Pipeline::next_keyframe(std::uint64_t epoch) {
  const auto found = recorded_.find(epoch);
  return found != recorded_.end() && found->second.keyframe_skipped ? nullptr : keyframe_.get();
}

void Pipeline::push_keyframe() {
  const auto found = recorded_.find(keyframe_->index);
  iterations_allowed_ = found == recorded_.end() ? -1 : found->second.iterations;
  smoother_->process(*keyframe_, this);
}

void Pipeline::no_keyframe(const Solution& filter, bool due) { smoother_->pass(filter, due); }

bool Pipeline::may_iterate(int iterations_done) {
  return iterations_allowed_ < 0 || iterations_done < iterations_allowed_;
}

void Pipeline::push_inertial(const InertialWork& work) { inertial_.process(work); }
void Pipeline::push_gnss(const GnssWork& work) { gnss_.process(work); }
void Pipeline::event(const Event& event) { sink_->on_event(event); }

}  // namespace leonav
