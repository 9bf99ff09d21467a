#include "daemon/engine/internal/output_publisher.h"

#include <algorithm>

#include "daemon/threads/wall_clock.h"

namespace leonav {
namespace {

constexpr std::size_t kMainOutBytes = 128 << 10;

}  // namespace

OutputPublisher::OutputPublisher(const OutputRings& rings, Wakeup* wakeup, MessageTarget* target,
                                 Journal* journal, EngineCounters* counters)
    : rings_(rings),
      wakeup_(wakeup),
      main_ring_(kMainOutBytes, wakeup),
      target_(target),
      journal_(journal),
      counters_(counters) {}

std::string OutputPublisher::start(const ThreadConfig& config) {
  return thread_.start(
      "out", config, [this] { run(); }, RealtimeThread::kSmallStackBytes);
}

void OutputPublisher::finish() {
  no_more_.store(true, std::memory_order_release);
  wakeup_->notify();
  thread_.join();
}

void OutputPublisher::publish(Channel channel, ByteSpan bytes) {
  if (!main_ring_.try_push(channel, wall_clock_us(), bytes)) counters_->unpublished.add(1);
}

void OutputPublisher::run() {
  for (;;) {
    const std::uint32_t ticket = wakeup_->ticket();
    const bool last_round = no_more_.load(std::memory_order_acquire);
    while (drain()) {
    }
    if (last_round) return;
    wakeup_->wait(ticket);
  }
}

// One message of every ring. False: all were empty.
bool OutputPublisher::drain() {
  const auto write = [this](const MessageHeader& header, ByteSpan bytes) {
    pass_on(header, bytes);
  };
  // The inputs that caused an output were pushed before it, so once it is seen they are in the ring
  // of `io`; they go first.
  const auto write_after_causes = [&](const MessageHeader& header, ByteSpan bytes) {
    rings_.io->consume_present(write);
    pass_on(header, bytes);
  };
  // An answer of the smoother depends on which of its earlier answers came too late, and on the
  // keyframes that found no room.
  const auto write_after_decisions = [&](const MessageHeader& header, ByteSpan bytes) {
    for (MessageRing* ring : {rings_.inertial, rings_.gnss})
      ring->consume_present(write_after_causes);
    write_after_causes(header, bytes);
  };
  bool any = rings_.io->consume_one(write);
  if (rings_.smoother != nullptr) any = rings_.smoother->consume_one(write_after_decisions) || any;
  for (MessageRing* ring : {rings_.inertial, rings_.gnss, &main_ring_}) {
    any = ring->consume_one(write_after_causes) || any;
  }
  return any;
}

void OutputPublisher::pass_on(const MessageHeader& header, ByteSpan bytes) {
  if (!is_replayed(header.channel)) {
    target_->take(header.channel, bytes);
    counters_->published.add(1);
  }
  journal_->push(header, bytes);
}

boost::container::static_vector<const MessageRing*, 5> OutputPublisher::all_rings() const {
  boost::container::static_vector<const MessageRing*, 5> rings{rings_.io, rings_.inertial,
                                                               rings_.gnss, &main_ring_};
  if (rings_.smoother != nullptr) rings.push_back(rings_.smoother);
  return rings;
}

bool OutputPublisher::idle() const {
  const auto rings = all_rings();
  return std::all_of(rings.begin(), rings.end(),
                     [](const MessageRing* ring) { return ring->idle(); });
}

RingStatistics OutputPublisher::worst_ring() const {
  RingStatistics worst;
  for (const MessageRing* ring : all_rings()) {
    const RingStatistics one = ring->statistics();
    worst.high_water_percent = std::max(worst.high_water_percent, one.high_water_percent);
    worst.waits += one.waits;
  }
  return worst;
}

WorkCount OutputPublisher::work() const {
  WorkCount sum;
  for (const MessageRing* ring : all_rings()) {
    const WorkCount one = ring->count();
    sum.done += one.done;
    sum.pushed += one.pushed;
  }
  return sum;
}

}  // namespace leonav
