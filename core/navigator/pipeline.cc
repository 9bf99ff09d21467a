#include "core/navigator/pipeline.h"

#include <variant>

namespace leonav {

Pipeline::Pipeline(const NavigatorConfig& config, OutputSink* sink)
    : sink_(sink),
      inertial_(config, &ekf_mailbox_, sink),
      gnss_(config, &ekf_mailbox_, sink),
      sequencer_(config, this) {}

void Pipeline::record_miss(std::uint64_t epoch) { recorded_misses_[epoch] = true; }

void Pipeline::open_epoch(std::uint64_t index) {
  ekf_mailbox_.open(index);  // a slot still under way makes this epoch a miss, as in the daemon
  const auto miss = recorded_misses_.find(index);
  if (miss == recorded_misses_.end()) return;
  ekf_mailbox_.cancel(index);
  recorded_misses_.erase(miss);
}

void Pipeline::push_inertial(const InertialWork& work) { inertial_.process(work); }
void Pipeline::push_gnss(const GnssWork& work) { gnss_.process(work); }
void Pipeline::event(const Event& event) { sink_->on_event(event); }

}  // namespace leonav
