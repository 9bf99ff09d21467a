// The Engine runs the navigator's stages in their threads, with rings between them and a journal.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/navigator/sequencer/sequencer.h"
#include "core/navigator/stages/gnss_stage.h"
#include "core/navigator/stages/inertial_navigator.h"
#include "daemon/checkpoint/checkpoint_writer.h"
#include "daemon/config/daemon_config.h"
#include "daemon/engine/internal/gnss_ring.h"
#include "daemon/engine/internal/output_publisher.h"
#include "daemon/engine/internal/refusals.h"
#include "daemon/engine/internal/smoother_worker.h"
#include "daemon/engine/internal/stage_sink.h"
#include "daemon/journal/journal.h"
#include "daemon/messages/input_dispatch.h"
#include "daemon/threads/counters.h"
#include "daemon/threads/realtime_thread.h"
#include "daemon/threads/work_ring.h"

namespace leonav {

// Calls by which a test holds a thread still, or lets a disk fail; empty in production.
struct EngineHooks {
  std::function<void(std::uint64_t epoch)> before_epoch;      // in `gnss`
  std::function<void(std::uint64_t epoch)> before_iteration;  // in `smoother`
  DiskHook disk_call;                                         // in `journal`
  CheckpointHook checkpoint_write;                            // in `file`
};

// It is everything of the daemon but the LCM socket. Threads: the caller of receive() is `io`. The
// engine's own are `ins`, `gnss`, `smoother` (if it gives the answer), `out` (OutputPublisher),
// `journal`, and `file`, which writes the checkpoint. Rings: io -> ins, io -> gnss, gnss ->
// smoother, and from io, ins, gnss, smoother and the caller of publish() (`main`) to out, out ->
// journal.
class Engine final : private StageInputs {
 public:
  // `target` gets every output, in the `out` thread.
  Engine(const DaemonConfig& config, MessageTarget* target, EngineHooks hooks = {});
  ~Engine() override;

  // Opens the journal and starts the threads. Throws EventLogError if the journal can never be
  // created (Journal::open()); one that exists is left alone, see journal().path(). Returns what
  // the system refused (priorities, ...); empty: nothing.
  std::vector<std::string> start();

  // An input as it came. One thread; waits while the stages are behind, drops nothing.
  void receive(Channel channel, ByteSpan bytes, std::int64_t timestamp_us);

  // An input that the same thread refuses by itself. It is counted and reported as one that
  // receive() refuses.
  void refuse(Channel channel, InputFault fault, std::int64_t timestamp_us);

  // An output of the same thread that is sent again soon. Where `out` is stuck the message is
  // dropped, which is not counted.
  void publish_from_io(Channel channel, ByteSpan bytes, std::int64_t timestamp_us) {
    io_sink_.ring().try_push(channel, timestamp_us, bytes);
  }

  // A message of the daemon itself (HEALTH). One thread. Where `out` is stuck the message is
  // dropped and counted, so that `main` stays able to take a signal.
  void publish(Channel channel, ByteSpan bytes) { publisher_.publish(channel, bytes); }

  // True once everything received so far has been dealt with by all stages.
  bool idle() const;
  // The same, whatever `gnss` still has to do.
  bool idle_but_gnss() const;

  // After the last receive(): lets every stage finish its work, closes the journal. False if the
  // journal is incomplete; journal().error() says why.
  bool finish();

  const DaemonConfig& config() const { return config_; }  // that it was made with
  EngineCounters& counters() { return counters_; }
  RingStatistics inertial_ring() const { return inertial_ring_.statistics(); }
  RingStatistics gnss_ring() const { return gnss_ring_.statistics(); }
  // The worst of those to `out`.
  RingStatistics out_ring() const { return publisher_.worst_ring(); }
  WorkCount inertial_work() const { return inertial_ring_.count(); }
  WorkCount gnss_work() const { return gnss_ring_.count(); }
  WorkCount smoother_work() const { return smoother_ != nullptr ? smoother_->work() : WorkCount(); }
  WorkCount out_work() const { return publisher_.work(); }  // of all rings to `out`
  const Journal& journal() const { return journal_; }
  Journal& journal() { return journal_; }
  // Any thread: what is journaled around now is worth keeping.
  void keep_journal() { journal_.keep(); }
  // What keeps the checkpoint's file from being written; empty: nothing.
  std::string checkpoint_error() const { return checkpoint_writer_.error(); }

 private:
  void open_epoch(std::uint64_t index) override;
  void push_inertial(const InertialWork& work) override { inertial_ring_.push(work); }
  void push_gnss(const GnssWork& work) override { gnss_ring_.push(work); }
  void event(const Event& event) override { io_sink_.on_event(event); }

  void keep_product(Channel channel);
  void write_refusals(InputFault fault, std::int64_t timestamp_us);
  void run_inertial();
  void run_gnss();

  DaemonConfig config_;
  EngineHooks hooks_;
  EngineCounters counters_;
  Journal journal_;
  Wakeup inertial_wakeup_, gnss_wakeup_, out_wakeup_;
  WorkRing<InertialWork> inertial_ring_;
  GnssRing gnss_ring_;
  CheckpointWriter checkpoint_writer_;
  StageSink io_sink_, inertial_sink_, gnss_sink_;
  TimedMailbox<Anchor> ekf_mailbox_;
  std::unique_ptr<SmootherWorker> smoother_;  // nullptr: the filter gives the answer
  OutputPublisher publisher_;
  InertialNavigator inertial_;
  GnssStage gnss_;
  Sequencer sequencer_;
  InputDispatch dispatch_;
  Refusals refusals_;
  std::atomic<bool> no_more_inputs_{false};
  bool started_ = false, finished_ = false;
  RealtimeThread inertial_thread_, gnss_thread_;
};

}  // namespace leonav
