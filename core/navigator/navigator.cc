#include "core/navigator/navigator.h"

namespace leonav {

Navigator::Navigator(const NavigatorConfig& config, OutputSink* sink)
    : sink_(sink),
      smoother_(config.estimator == Estimator::kSmoother
                    ? std::make_unique<SmootherStage>(config, &smoother_mailbox_, sink)
                    : nullptr),
      inertial_(config, &ekf_mailbox_, &smoother_mailbox_, sink),
      gnss_(config, &ekf_mailbox_, smoother_ != nullptr ? this : nullptr, sink),
      sequencer_(config, this) {
  if (smoother_ != nullptr) keyframe_ = std::make_unique<KeyframeInput>();
}

void Navigator::record(const Decision& decision) {
  if (decision.committed && decision.subject != Decision::Subject::kSmoother) return;
  Recorded& recorded = recorded_[decision.epoch];
  if (decision.subject == Decision::Subject::kFilter) recorded.ekf_missed = true;
  if (decision.subject == Decision::Subject::kKeyframe) recorded.keyframe_skipped = true;
  if (decision.subject != Decision::Subject::kSmoother) return;
  recorded.smoother_missed = !decision.committed;
  recorded.iterations = decision.iterations;
}

// If the slot is still occupied, open() fails and this epoch is a miss, as in the daemon.
void Navigator::open_epoch(std::uint64_t index) {
  ekf_mailbox_.open(index);
  if (smoother_ != nullptr) smoother_mailbox_.open(index);
  const auto found = recorded_.find(index);
  if (found == recorded_.end()) return;
  if (found->second.ekf_missed) ekf_mailbox_.cancel(index);
  if (found->second.smoother_missed) smoother_mailbox_.cancel(index);
}

KeyframeInput* Navigator::next_keyframe(std::uint64_t epoch) {
  const auto found = recorded_.find(epoch);
  return found != recorded_.end() && found->second.keyframe_skipped ? nullptr : keyframe_.get();
}

void Navigator::push_keyframe() {
  const auto found = recorded_.find(keyframe_->index);
  iterations_allowed_ = found == recorded_.end() ? -1 : found->second.iterations;
  smoother_->process(*keyframe_, this);
}

void Navigator::no_keyframe(const Solution& filter, bool due) {
  smoother_->process_non_keyframe(filter, due);
}

bool Navigator::result_of(std::uint64_t epoch, SmootherAnchor* result) {
  return smoother_mailbox_.read(epoch, result);
}

bool Navigator::may_iterate(int iterations_done) {
  return iterations_allowed_ < 0 || iterations_done < iterations_allowed_;
}

void Navigator::push_inertial(const InertialWork& work) { inertial_.process(work); }
void Navigator::push_gnss(const GnssWork& work) { gnss_.process(work); }
void Navigator::event(const Event& event) { sink_->on_event(event); }

}  // namespace leonav
