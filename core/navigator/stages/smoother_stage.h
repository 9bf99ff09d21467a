// SmootherStage feeds keyframes to the smoother and delivers its results as anchors and reports.
#pragma once
#include <cstdint>

#include "core/navigator/interface/event_source.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/stage_work.h"
#include "core/navigator/interface/timed_mailbox.h"
#include "core/smoother/smoother.h"

namespace leonav {

// SmootherStage allocates when constructed, not after.
class SmootherStage {
 public:
  SmootherStage(const NavigatorConfig& config, TimedMailbox<SmootherAnchor>* mailbox,
                OutputSink* sink);

  // Adds the keyframe, solves under `budget`, delivers and reports; it allocates nothing and never
  // throws.
  //
  // A keyframe whose deadline has already passed is added but not solved; the next solve includes
  // it. Without IMU there is no deadline, and this function publishes the solution.
  void process(const KeyframeInput& input, SolveBudget* budget);

  // Delivers an empty result for an epoch that is no keyframe; without IMU it publishes the
  // solution `filter` instead. With IMU it is the only member that may be called in another thread,
  // that of the GNSS stage.
  void process_non_keyframe(const Solution& filter, bool due);

  const Smoother& smoother() const { return smoother_; }
  // Returns the source of the last published solution; only without IMU.
  Source source() const { return source_; }

 private:
  void add_levels(const KeyframeInput& input, bool filter_is_younger, Anchor* anchor) const;
  SmootherAnchor anchor_of(const KeyframeInput& input, const SmootherResult& result) const;
  void publish(Solution solution);
  void report(const KeyframeInput& input, const SmootherResult& result,
              const SmootherAnchor& update);

  TimedMailbox<SmootherAnchor>* mailbox_;
  OutputSink* sink_;
  EventSource events_;
  bool inertial_;
  IntegrityConfig integrity_;
  Smoother smoother_;
  Source source_ = Source::kNone;
  std::uint64_t next_report_ = 1, next_solution_ = 1;
};

}  // namespace leonav
