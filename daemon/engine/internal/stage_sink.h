// A StageSink encodes the outputs of one stage into its ring to `out`, and updates the counters.
#pragma once
#include "core/navigator/monitors/orbit_source_monitor.h"
#include "daemon/messages/encoding_sink.h"
#include "daemon/threads/counters.h"
#include "daemon/threads/latest_value.h"
#include "daemon/threads/message_ring.h"

namespace leonav {

class StageSink final : public OutputSink, private MessageTarget {
 public:
  // `checkpoints`: receives the checkpoint of each epoch; nullptr: none is kept.
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
  OrbitSourceMonitor orbit_source_monitor_;
};

}  // namespace leonav
