// The output end of one stage: encodes into its ring to `out`, and notes what health wants to know.
#pragma once
#include "core/navigator/orbit_watch.h"
#include "daemon/counters.h"
#include "daemon/encoding_sink.h"
#include "daemon/latest_value.h"
#include "daemon/message_ring.h"

namespace leonav {

class StageSink final : public OutputSink, private MessageTarget {
 public:
  // `checkpoints`: where each epoch's goes; nullptr: nowhere.
  StageSink(std::size_t ring_bytes, Wakeup* out, EngineCounters* counters,
            LatestValue<Checkpoint>* checkpoints = nullptr)
      : ring_(ring_bytes, out), encoder_(this), counters_(counters), checkpoints_(checkpoints) {}

  void on_solution(const Solution& solution) override;
  void on_epoch(const EpochReport& report) override;
  void on_event(const Event& event) override;
  void on_decision(const Decision& decision) override;
  void on_smoother(const SmootherReport& report) override;

  MessageRing& ring() { return ring_; }
  const MessageRing& ring() const { return ring_; }

 private:
  void take(Channel channel, ByteSpan bytes) override;

  MessageRing ring_;
  EncodingSink encoder_;
  EngineCounters* counters_;
  LatestValue<Checkpoint>* checkpoints_;
  OrbitWatch orbit_watch_;
};

// Wall-clock time as LCM logs stamp it: microseconds since 1970.
std::int64_t wall_clock_us();

}  // namespace leonav
