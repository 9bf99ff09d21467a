// The OutputPublisher is the thread `out`: it passes messages on to the target and the journal.
#pragma once
#include <atomic>
#include <boost/container/static_vector.hpp>
#include <string>

#include "daemon/journal/journal.h"
#include "daemon/messages/encoding_sink.h"
#include "daemon/threads/counters.h"
#include "daemon/threads/message_ring.h"
#include "daemon/threads/realtime_thread.h"

namespace leonav {

// The rings that the stages write their messages to.
struct OutputRings {
  MessageRing* io = nullptr;  // inputs as they came, and the Sequencer's events
  MessageRing* inertial = nullptr;
  MessageRing* gnss = nullptr;
  MessageRing* smoother = nullptr;  // nullptr: there is no smoother
};

// Inputs go to the journal, outputs to the target and the journal. An output is written after all
// messages that it depends on, so that a journal replays wherever it is cut.
class OutputPublisher {
 public:
  // `wakeup`: the one that the rings notify. `target` gets every output, in this thread.
  OutputPublisher(const OutputRings& rings, Wakeup* wakeup, MessageTarget* target, Journal* journal,
                  EngineCounters* counters);

  std::string start(const ThreadConfig& config);  // what the system refused; empty: nothing
  // After the last message: passes on what is left and ends the thread.
  void finish();

  // A message of the daemon itself; thread `main`. Where this thread is stuck the message is
  // dropped and counted.
  void publish(Channel channel, ByteSpan bytes);

  // Any thread, over all rings.
  bool idle() const;
  RingStatistics worst_ring() const;
  WorkCount work() const;

 private:
  boost::container::static_vector<const MessageRing*, 5> all_rings() const;
  void run();
  bool drain();
  void pass_on(const MessageHeader& header, ByteSpan bytes);

  OutputRings rings_;
  Wakeup* wakeup_;
  MessageRing main_ring_;
  MessageTarget* target_;
  Journal* journal_;
  EngineCounters* counters_;
  std::atomic<bool> no_more_{false};
  RealtimeThread thread_;
};

}  // namespace leonav
