// Everything of the daemon except the LCM socket: the stages in their threads, the rings between
// them, the journal.
#pragma once
#include <atomic>
#include <boost/container/static_vector.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/navigator/gnss_stage.h"
#include "core/navigator/inertial_navigator.h"
#include "core/navigator/sequencer.h"
#include "daemon/checkpoint_keeper.h"
#include "daemon/config/daemon_config.h"
#include "daemon/counters.h"
#include "daemon/input_dispatch.h"
#include "daemon/realtime_thread.h"
#include "daemon/smoother_worker.h"
#include "daemon/stage_sink.h"
#include "daemon/work_ring.h"
#include "drivers/lcm/event_log.h"

namespace leonav {

// Where tests hold a thread still; empty in production.
struct EngineHooks {
  std::function<void(std::uint64_t epoch)> before_epoch;      // in `gnss`
  std::function<void(std::uint64_t epoch)> before_iteration;  // in `smoother`
};

// Threads: the caller of receive() is `io`; `ins`, `gnss`, `smoother` (if it gives the answer) and
// `out` are the engine's own, and so is `file`, which writes the checkpoint. Rings: io -> ins, io
// -> gnss, gnss -> smoother, and from io, ins, gnss, smoother and the caller of publish() (`main`)
// to out.
class Engine final : private StageInputs {
 public:
  // `target` gets every output, in the `out` thread.
  Engine(const DaemonConfig& config, MessageTarget* target, EngineHooks hooks = {});
  ~Engine() override;

  // Opens the journal and starts the threads. Throws EventLogError if the journal cannot be
  // created; one that exists is left alone, see journal_path(). Returns what the system refused
  // (priorities, ...); empty: nothing.
  std::vector<std::string> start();

  // An input as it came. One thread; waits while the stages are behind, drops nothing.
  void receive(Channel channel, ByteSpan bytes, std::int64_t timestamp_us);

  // A message of the daemon itself (HEALTH). One thread. Where `out` is stuck (a disk that hangs)
  // the message is dropped and counted: `main` must stay able to take a signal.
  void publish(Channel channel, ByteSpan bytes) {
    if (!main_ring_.try_push(channel, wall_clock_us(), bytes)) counters_.unpublished.add(1);
  }

  // True once everything received so far has been dealt with by all stages.
  bool idle() const;
  // The same, whatever `gnss` still has to do.
  bool idle_but_gnss() const;

  // After the last receive(): lets every stage finish its work, closes the journal. False if the
  // journal is incomplete; journal_error() says why.
  bool finish();

  EngineCounters& counters() { return counters_; }
  RingStatistics inertial_ring() const { return inertial_ring_.statistics(); }
  RingStatistics gnss_ring() const { return gnss_ring_.statistics(); }
  RingStatistics out_ring() const;  // the worst of those to `out`
  WorkCount inertial_work() const { return inertial_ring_.count(); }
  WorkCount gnss_work() const { return gnss_ring_.count(); }
  WorkCount smoother_work() const { return smoother_ != nullptr ? smoother_->work() : WorkCount(); }
  WorkCount out_work() const;  // of all rings to `out`
  // After start(): where the journal is written; empty: nowhere.
  const std::string& journal_path() const { return config_.journal.path; }
  // Valid once counters().journal_failed is set.
  const std::string& journal_error() const { return journal_error_; }
  // What keeps the checkpoint's file from being written; empty: nothing.
  std::string checkpoint_error() const { return checkpoint_keeper_.error(); }

 private:
  void open_epoch(std::uint64_t index) override;
  void push_inertial(const InertialWork& work) override { inertial_ring_.push(work); }
  void push_gnss(const GnssWork& work) override { gnss_ring_.push(work); }
  void event(const Event& event) override { io_sink_.on_event(event); }

  void run_inertial();
  void run_gnss();
  void run_out();
  boost::container::static_vector<const MessageRing*, 5> out_rings() const;
  bool drain_outputs();
  void journal_configuration();
  void journal_end();
  void write_out(const MessageHeader& header, ByteSpan bytes);
  void write_journal(const MessageHeader& header, ByteSpan bytes);
  void flush_journal(bool sync);
  void update_io_counters();

  DaemonConfig config_;
  MessageTarget* target_;
  EngineHooks hooks_;
  EngineCounters counters_;
  std::unique_ptr<EventLogWriter> journal_;
  std::string journal_error_;
  std::vector<std::string> channel_names_;
  Wakeup inertial_wakeup_, gnss_wakeup_, out_wakeup_;
  WorkRing<InertialWork> inertial_ring_;
  WorkRing<GnssWork> gnss_ring_;
  CheckpointKeeper checkpoint_keeper_;
  StageSink io_sink_, inertial_sink_, gnss_sink_;
  MessageRing main_ring_;
  TimedMailbox<EkfUpdate> ekf_mailbox_;
  std::unique_ptr<SmootherWorker> smoother_;  // nullptr: the filter gives the answer
  InertialNavigator inertial_;
  GnssStage gnss_;
  Sequencer sequencer_;
  InputDispatch dispatch_;
  std::atomic<bool> no_more_inputs_{false}, no_more_outputs_{false};
  bool started_ = false, finished_ = false;
  RealtimeThread inertial_thread_, gnss_thread_, out_thread_;
};

}  // namespace leonav
