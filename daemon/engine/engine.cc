#include "daemon/engine/engine.h"

#include <span>
#include <utility>

#include "daemon/engine/internal/input_counters.h"
#include "daemon/threads/process_memory.h"
#include "daemon/threads/wall_clock.h"

namespace leonav {
namespace {

constexpr std::size_t kInertialRing = 4096;  // 20 s at 200 Hz
// `out` waits for no disk: it is behind by no more than what the system keeps it from running.
constexpr std::size_t kInputRingBytes = 512 << 10;
constexpr std::size_t kInertialOutBytes = 512 << 10;  // 6 s of SOLUTION at 200 Hz
constexpr std::size_t kGnssOutBytes = 512 << 10;

}  // namespace

Engine::Engine(const DaemonConfig& config, MessageTarget* target, EngineHooks hooks)
    : config_(config),
      hooks_(std::move(hooks)),
      journal_(config, hooks_.disk_call),
      inertial_ring_(kInertialRing, &inertial_wakeup_),
      gnss_ring_(&gnss_wakeup_),
      checkpoint_writer_(config.checkpoint, hooks_.checkpoint_write),
      io_sink_(kInputRingBytes, &out_wakeup_, &counters_),
      inertial_sink_(kInertialOutBytes, &out_wakeup_, &counters_),
      gnss_sink_(kGnssOutBytes, &out_wakeup_, &counters_, checkpoint_writer_.latest()),
      smoother_(config.navigator.estimator == Estimator::kSmoother
                    ? std::make_unique<SmootherWorker>(config.navigator, &out_wakeup_, &counters_,
                                                       hooks_.before_iteration)
                    : nullptr),
      publisher_({&io_sink_.ring(), &inertial_sink_.ring(), &gnss_sink_.ring(),
                  smoother_ != nullptr ? &smoother_->outputs() : nullptr},
                 &out_wakeup_, target, &journal_, &counters_),
      inertial_(config.navigator, &ekf_mailbox_,
                smoother_ != nullptr ? smoother_->mailbox() : nullptr, &inertial_sink_),
      gnss_(config.navigator, &ekf_mailbox_, smoother_.get(), &gnss_sink_),
      sequencer_(config.navigator, this),
      dispatch_(&sequencer_) {
  for (Gauge& age : counters_.ephemeris_age_ms) age.set(-1);
  for (Gauge& age : counters_.age_by_source_ms) age.set(-1);
  counters_.odometer_age_ms.set(-1);
}

Engine::~Engine() { finish(); }

std::vector<std::string> Engine::start() {
  std::vector<std::string> refused;
  journal_.open();
  const ThreadsConfig& threads = config_.threads;
  if (threads.lock_memory) {
    const SmootherConfig& smoother = config_.navigator.smoother;
    refused.push_back(
        lock_memory(smoother_ != nullptr && smoother.solver == SmootherSolver::kCeres));
  }
  started_ = true;
  checkpoint_writer_.start();
  refused.push_back(publisher_.start(threads.out));
  // Before the smoother's, because it uses more of its stack: where the smoother's time was
  // measured, it gets that thread's, which is larger.
  refused.push_back(gnss_thread_.start(
      "gnss", threads.gnss, [this] { run_gnss(); }, RealtimeThread::kEstimatorStackBytes));
  if (smoother_ != nullptr) refused.push_back(smoother_->start(threads.smoother));
  refused.push_back(inertial_thread_.start("ins", threads.ins, [this] { run_inertial(); }));
  std::erase(refused, std::string());
  return refused;
}

void Engine::receive(Channel channel, ByteSpan bytes, std::int64_t timestamp_us) {
  bytes = limit_length(bytes);
  const InputFault fault = dispatch_.decode(channel, bytes);
  if (fault != InputFault::kNone) return refuse(channel, fault, timestamp_us);
  // Before it is dealt with: what a stage does must never be in the journal without its cause.
  if (journal_.is_open()) io_sink_.ring().push(channel, timestamp_us, bytes);
  dispatch_.accept();
  keep_product(channel);
  copy_input_counters(dispatch_, sequencer_, &counters_);
}

// For the next start. What no filter would take is not worth keeping.
void Engine::keep_product(Channel channel) {
  if (config_.checkpoint.path.empty()) return;
  const Ephemeris& ephemeris = dispatch_.ephemeris();
  if (channel == Channel::kEphemeris && is_valid(ephemeris.satellite) && is_sane(ephemeris))
    checkpoint_writer_.products()->keep(ephemeris);
  const SignalBiases& biases = dispatch_.biases();
  if (channel == Channel::kBiases)
    checkpoint_writer_.products()->keep(std::span(biases.data(), biases.size()));
  if (channel == Channel::kIonosphere) checkpoint_writer_.products()->keep(dispatch_.ionosphere());
}

// The journal need only know the number where the next one is an event: before it.
void Engine::refuse(Channel channel, InputFault fault, std::int64_t timestamp_us) {
  refusals_.add(channel, fault);
  if (sequencer_.is_refusal_due(fault)) write_refusals(fault, timestamp_us);
  dispatch_.refuse({channel, fault, 1});
  copy_input_counters(dispatch_, sequencer_, &counters_);
}

void Engine::write_refusals(InputFault fault, std::int64_t timestamp_us) {
  if (!journal_.is_open()) return;
  refusals_.take(fault, [&](const RefusedInputs& refused, std::uint64_t sequence) {
    io_sink_.ring().push(Channel::kRefused, timestamp_us, encode_refused(refused, sequence));
  });
}

// A slot still in use from kMaxMailboxEpochs ago is left alone: the epoch becomes a miss, which is
// a decision in the journal like any other.
void Engine::open_epoch(std::uint64_t index) {
  ekf_mailbox_.open(index);
  if (smoother_ != nullptr) smoother_->mailbox()->open(index);
}

bool Engine::idle() const { return gnss_ring_.idle() && idle_but_gnss(); }

bool Engine::idle_but_gnss() const {
  // In the order of flow: what a stage has not done could still feed the next one.
  if (!inertial_ring_.idle() || (smoother_ != nullptr && !smoother_->idle())) return false;
  return publisher_.idle();
}

bool Engine::finish() {
  if (started_ && !finished_) {
    for (std::size_t i = 0; i < kInputFaultCount; ++i)
      write_refusals(static_cast<InputFault>(i), wall_clock_us());
    no_more_inputs_.store(true, std::memory_order_release);
    inertial_wakeup_.notify();
    gnss_wakeup_.notify();
    inertial_thread_.join();
    gnss_thread_.join();
    if (smoother_ != nullptr) smoother_->finish();
    publisher_.finish();
    journal_.finish();
    checkpoint_writer_.finish();
  }
  finished_ = true;
  return journal_.error().empty();
}

void Engine::run_inertial() {
  for (;;) {
    const std::uint32_t ticket = inertial_wakeup_.ticket();
    // Read before looking for work, so that what was pushed before it was set is still done.
    const bool last_round = no_more_inputs_.load(std::memory_order_acquire);
    while (inertial_ring_.consume_one([this](const InertialWork& work) {
      const Stopwatch watch;
      inertial_.process(work);
      counters_.source.set(static_cast<std::int64_t>(inertial_.source()));
      counters_.worst_tick_ns.raise_to(watch.nanoseconds());
    })) {
    }
    if (last_round) return;
    inertial_wakeup_.wait(ticket);
  }
}

void Engine::run_gnss() {
  const bool publishes = config_.navigator.motion != MotionModel::kInertial;
  for (;;) {
    const std::uint32_t ticket = gnss_wakeup_.ticket();
    const bool last_round = no_more_inputs_.load(std::memory_order_acquire);
    while (gnss_ring_.consume_one([this, publishes](const GnssWork& work) {
      const auto* epoch = std::get_if<EpochWork>(&work);
      if (epoch != nullptr && hooks_.before_epoch) hooks_.before_epoch(epoch->index);
      const Stopwatch watch;
      gnss_.process(work);
      if (publishes) {
        Source source = gnss_.source();
        if (smoother_ != nullptr && source != Source::kNone) source = smoother_->source();
        counters_.source.set(static_cast<std::int64_t>(source));
      }
      if (epoch != nullptr) {
        counters_.worst_epoch_ns.raise_to(watch.nanoseconds());
      }
    })) {
    }
    if (last_round) return;
    gnss_wakeup_.wait(ticket);
  }
}

}  // namespace leonav
