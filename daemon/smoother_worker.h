// The smoother in a thread of its own: keyframes in, results to the mailbox before their deadline.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "core/navigator/smoother_stage.h"
#include "daemon/counters.h"
#include "daemon/keyframe_ring.h"
#include "daemon/realtime_thread.h"
#include "daemon/stage_sink.h"

namespace leonav {

// Where there is no IMU no result has a deadline: the smoother then works in the GNSS thread, which
// waits for it, and no thread is started.
class SmootherWorker final : public KeyframeSink, private SolveBudget {
 public:
  SmootherWorker(const NavigatorConfig& config, Wakeup* out, EngineCounters* counters,
                 std::function<void(std::uint64_t epoch)> before_iteration);

  std::string start(const ThreadConfig& config);  // what the system refused; empty: nothing
  // After the last keyframe: does what is left.
  void finish();

  // GNSS thread.
  KeyframeInput* next_keyframe(std::uint64_t epoch) override;
  void push_keyframe() override;
  void no_keyframe(const Solution& filter, bool due) override;

  // Of the answer, in the thread that works where there is no IMU.
  Source source() const { return stage_.source(); }

  TimedMailbox<SmootherUpdate>* mailbox() { return &mailbox_; }
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
  TimedMailbox<SmootherUpdate> mailbox_;
  SmootherStage stage_;
  std::uint64_t epoch_ = 0;  // of the solve at hand
  Stopwatch solve_watch_;
  std::atomic<bool> no_more_{false};
  RealtimeThread thread_;
};

}  // namespace leonav
