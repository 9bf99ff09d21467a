// The SmootherWorker runs the smoother stage in its own thread, with a deadline for each result.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "core/navigator/stages/smoother_stage.h"
#include "daemon/engine/internal/stage_sink.h"
#include "daemon/threads/counters.h"
#include "daemon/threads/keyframe_ring.h"
#include "daemon/threads/realtime_thread.h"

namespace leonav {

// Keyframes come through a ring, results go to the mailbox. Without an IMU no result has a
// deadline: the smoother then runs in the GNSS thread, which waits for it, and no thread is
// started.
class SmootherWorker final : public KeyframeSink, private SolveBudget {
 public:
  SmootherWorker(const NavigatorConfig& config, Wakeup* out, EngineCounters* counters,
                 std::function<void(std::uint64_t epoch)> before_iteration);

  std::string start(const ThreadConfig& config);  // what the system refused; empty: nothing
  // After the last keyframe: processes those left and ends the thread.
  void finish();

  // GNSS thread.
  KeyframeInput* next_keyframe(std::uint64_t epoch) override;
  void push_keyframe() override;
  void no_keyframe(const Solution& filter, bool due) override;
  bool result_of(std::uint64_t epoch, SmootherAnchor* result) override;

  // Source of the last answer; without an IMU, in the GNSS thread.
  Source source() const { return stage_.source(); }

  TimedMailbox<SmootherAnchor>* mailbox() { return &mailbox_; }
  MessageRing& outputs() { return sink_.ring(); }
  const MessageRing& outputs() const { return sink_.ring(); }
  bool idle() const { return ring_.idle(); }
  WorkCount work() const { return ring_.count(); }

 private:
  void run();
  void process(const KeyframeInput& keyframe);
  bool may_iterate(int iterations_done) override;

  bool inertial_;
  std::int64_t time_limit_ns_;
  EngineCounters* counters_;
  std::function<void(std::uint64_t)> before_iteration_;
  Wakeup wakeup_;
  KeyframeRing ring_;
  StageSink sink_;
  TimedMailbox<SmootherAnchor> mailbox_;
  SmootherStage stage_;
  std::uint64_t epoch_ = 0;  // of the current solve
  Stopwatch solve_watch_;
  std::atomic<bool> no_more_{false};
  RealtimeThread thread_;
};

}  // namespace leonav
