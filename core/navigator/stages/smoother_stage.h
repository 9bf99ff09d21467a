// SmootherStage feeds keyframes to the smoother and delivers its answer before the deadline.
#pragma once
#include <cstdint>

#include "core/navigator/interface/event_source.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/stage_work.h"
#include "core/navigator/interface/timed_mailbox.h"
#include "core/smoother/smoother.h"

namespace leonav {

class SmootherStage {
 public:
  SmootherStage(const NavigatorConfig& config, TimedMailbox<SmootherAnchor>* mailbox,
                OutputSink* sink);

  // Adds the keyframe, solves under `budget`, delivers, reports. A keyframe whose deadline has
  // passed already is added and not solved: the next one's solve catches up. Without IMU there is
  // no deadline, and the solution is published here. Allocates nothing, never throws.
  void process(const KeyframeInput& input, SolveBudget* budget);

  // Handles an epoch that is no keyframe. With IMU this is the only member that may be called in
  // another thread, that of the filter.
  void process_non_keyframe(const Solution& filter, bool due);

  const Smoother& smoother() const { return smoother_; }
  Smoother& smoother() { return smoother_; }
  Source source() const { return source_; }

 private:
  SmootherAnchor answer(const KeyframeInput& input, const SmootherResult& result) const;
  void publish(Solution solution);
  void report(const KeyframeInput& input, const SmootherResult& result,
              const SmootherAnchor& update);

  TimedMailbox<SmootherAnchor>* mailbox_;
  OutputSink* sink_;
  EventSource events_;
  bool inertial_;
  Smoother smoother_;
  Source source_ = Source::kNone;
  std::uint64_t next_report_ = 1, next_solution_ = 1;
};

}  // namespace leonav
