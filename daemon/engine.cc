#include "daemon/engine.h"

#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "daemon/journal_path.h"
#include "drivers/lcm/run_configuration.h"

namespace leonav {
namespace {

constexpr std::size_t kInertialRing = 4096;  // 20 s at 200 Hz
constexpr std::size_t kGnssRing = 32;        // an element can hold 140 kB
constexpr std::size_t kInputRingBytes = 1 << 20;
constexpr std::size_t kInertialOutBytes = 4 << 20;  // 50 s of SOLUTION at 200 Hz
constexpr std::size_t kGnssOutBytes = 1 << 20;
constexpr std::size_t kMainOutBytes = 128 << 10;

std::int64_t odometer_age_ms(const Sequencer& sequencer) {
  const GpsTime last = sequencer.odometer_time(), now = sequencer.imu_time();
  if (!last.is_set() || !now.is_set()) return -1;
  return std::max<std::int64_t>(0, (now.nanoseconds() - last.nanoseconds()) / 1'000'000);
}

}  // namespace

Engine::Engine(const DaemonConfig& config, MessageTarget* target, EngineHooks hooks)
    : config_(config),
      target_(target),
      hooks_(std::move(hooks)),
      inertial_ring_(kInertialRing, &inertial_wakeup_),
      gnss_ring_(kGnssRing, &gnss_wakeup_),
      checkpoint_keeper_(config.checkpoint),
      io_sink_(kInputRingBytes, &out_wakeup_, &counters_),
      inertial_sink_(kInertialOutBytes, &out_wakeup_, &counters_),
      gnss_sink_(kGnssOutBytes, &out_wakeup_, &counters_, checkpoint_keeper_.latest()),
      main_ring_(kMainOutBytes, &out_wakeup_),
      smoother_(config.navigator.estimator == Estimator::kSmoother
                    ? std::make_unique<SmootherWorker>(config.navigator, &out_wakeup_, &counters_,
                                                       hooks_.before_iteration)
                    : nullptr),
      inertial_(config.navigator, &ekf_mailbox_,
                smoother_ != nullptr ? smoother_->mailbox() : nullptr, &inertial_sink_),
      gnss_(config.navigator, &ekf_mailbox_, smoother_.get(), &gnss_sink_),
      sequencer_(config.navigator, this),
      dispatch_(&sequencer_) {
  for (std::size_t i = 0; i < kChannelCount; ++i) {
    channel_names_.push_back(channel_name(static_cast<Channel>(i), config.lcm.prefix));
  }
  for (Gauge& age : counters_.ephemeris_age_ms) age.set(-1);
  for (Gauge& age : counters_.age_by_source_ms) age.set(-1);
  counters_.odometer_age_ms.set(-1);
}

Engine::~Engine() { finish(); }

std::vector<std::string> Engine::start() {
  std::vector<std::string> refused;
  if (!config_.journal.path.empty()) {
    config_.journal.path = claim_journal_path(config_.journal.path);
    journal_ = std::make_unique<EventLogWriter>(config_.journal.path);
    journal_configuration();
  }
  const ThreadsConfig& threads = config_.threads;
  if (threads.lock_memory && mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    refused.push_back(std::string("memory is not locked: ") + std::strerror(errno));
  }
  started_ = true;
  checkpoint_keeper_.start();
  refused.push_back(out_thread_.start("out", threads.out, [this] { run_out(); }));
  if (smoother_ != nullptr) refused.push_back(smoother_->start(threads.smoother));
  refused.push_back(gnss_thread_.start("gnss", threads.gnss, [this] { run_gnss(); }));
  refused.push_back(inertial_thread_.start("ins", threads.ins, [this] { run_inertial(); }));
  std::erase(refused, std::string());
  return refused;
}

void Engine::receive(Channel channel, ByteSpan bytes, std::int64_t timestamp_us) {
  bytes = limit_length(bytes);
  // Before it is dealt with: what a stage does must never be in the journal without its cause.
  if (journal_ != nullptr) io_sink_.ring().push(channel, timestamp_us, bytes);
  dispatch_.dispatch(channel, bytes);
  update_io_counters();
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
  const auto rings = out_rings();
  return std::all_of(rings.begin(), rings.end(),
                     [](const MessageRing* ring) { return ring->idle(); });
}

bool Engine::finish() {
  if (started_ && !finished_) {
    no_more_inputs_.store(true, std::memory_order_release);
    inertial_wakeup_.notify();
    gnss_wakeup_.notify();
    inertial_thread_.join();
    gnss_thread_.join();
    if (smoother_ != nullptr) smoother_->finish();
    checkpoint_keeper_.finish();
    no_more_outputs_.store(true, std::memory_order_release);
    out_wakeup_.notify();
    out_thread_.join();
    journal_end();
    flush_journal(true);
  }
  finished_ = true;
  return counters_.journal_failed.get() == 0;
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

void Engine::run_out() {
  Stopwatch since_flush;
  const auto interval_ns = static_cast<std::int64_t>(config_.journal.flush_interval_s * 1e9);
  for (;;) {
    const std::uint32_t ticket = out_wakeup_.ticket();
    const bool last_round = no_more_outputs_.load(std::memory_order_acquire);
    while (drain_outputs()) {
      if (since_flush.nanoseconds() < interval_ns) continue;
      flush_journal(false);
      since_flush = Stopwatch();
    }
    if (last_round) return;
    out_wakeup_.wait(ticket);
  }
}

// One message of every ring. False: all were empty.
bool Engine::drain_outputs() {
  const auto write = [this](const MessageHeader& header, ByteSpan bytes) {
    write_out(header, bytes);
  };
  // An output's causes were pushed before it, so once it is seen they are in the ring of `io`; they
  // go first. Then a journal replays wherever it is cut.
  const auto write_after_causes = [&](const MessageHeader& header, ByteSpan bytes) {
    io_sink_.ring().consume_present(write);
    write_out(header, bytes);
  };
  // What the smoother answers depends on the answers of its that came too late before, and on the
  // keyframes that found no room.
  const auto write_after_decisions = [&](const MessageHeader& header, ByteSpan bytes) {
    for (MessageRing* ring : {&inertial_sink_.ring(), &gnss_sink_.ring()})
      ring->consume_present(write_after_causes);
    write_after_causes(header, bytes);
  };
  bool any = io_sink_.ring().consume_one(write);
  if (smoother_ != nullptr) any = smoother_->outputs().consume_one(write_after_decisions) || any;
  for (MessageRing* ring : {&inertial_sink_.ring(), &gnss_sink_.ring(), &main_ring_}) {
    any = ring->consume_one(write_after_causes) || any;
  }
  return any;
}

void Engine::journal_configuration() {
  const ConfigText& source = config_.source;
  if (source.text.empty()) return;
  const auto bytes = encode(
      RunConfiguration{"leonavd " LEONAV_VERSION, source.name, source.text, source.overrides});
  write_journal({wall_clock_us(), static_cast<std::uint32_t>(bytes.size()), Channel::kConfig},
                bytes);
}

void Engine::journal_end() {
  const auto bytes = encode_journal_end(journal_ == nullptr ? 0 : journal_->events());
  write_journal({wall_clock_us(), static_cast<std::uint32_t>(bytes.size()), Channel::kEnd}, bytes);
}

void Engine::write_out(const MessageHeader& header, ByteSpan bytes) {
  if (!is_input(header.channel)) {
    target_->take(header.channel, bytes);
    counters_.published.add(1);
  }
  write_journal(header, bytes);
}

void Engine::write_journal(const MessageHeader& header, ByteSpan bytes) {
  if (journal_ == nullptr || counters_.journal_failed.get() != 0) return;
  if (journal_->write(header.timestamp_us, channel_names_[index_of(header.channel)], bytes)) {
    counters_.journaled.add(1);
  } else {
    journal_error_ = journal_->error();
    counters_.journal_failed.set(1);
  }
}

void Engine::flush_journal(bool sync) {
  if (journal_ == nullptr || counters_.journal_failed.get() != 0) return;
  if (journal_->flush(sync)) return;
  journal_error_ = journal_->error();
  counters_.journal_failed.set(1);
}

boost::container::static_vector<const MessageRing*, 5> Engine::out_rings() const {
  boost::container::static_vector<const MessageRing*, 5> rings{
      &io_sink_.ring(), &inertial_sink_.ring(), &gnss_sink_.ring(), &main_ring_};
  if (smoother_ != nullptr) rings.push_back(&smoother_->outputs());
  return rings;
}

RingStatistics Engine::out_ring() const {
  RingStatistics worst;
  for (const MessageRing* ring : out_rings()) {
    const RingStatistics one = ring->statistics();
    worst.high_water_percent = std::max(worst.high_water_percent, one.high_water_percent);
    worst.waits += one.waits;
  }
  return worst;
}

WorkCount Engine::out_work() const {
  WorkCount sum;
  for (const MessageRing* ring : out_rings()) {
    const WorkCount one = ring->count();
    sum.done += one.done;
    sum.pushed += one.pushed;
  }
  return sum;
}

void Engine::update_io_counters() {
  const InputDispatch::Counters& inputs = dispatch_.counters();
  for (std::size_t i = 0; i < kInputChannels.size(); ++i) {
    counters_.received[i].set(static_cast<std::int64_t>(inputs.received[i]));
    counters_.lost[i].set(static_cast<std::int64_t>(inputs.lost[i]));
  }
  const Sequencer::Counters& sequencer = sequencer_.counters();
  for (std::size_t i = 0; i < sequencer.rejected.size(); ++i) {
    counters_.rejected[i].set(static_cast<std::int64_t>(sequencer.rejected[i]));
  }
  counters_.accepted_imu.set(static_cast<std::int64_t>(sequencer.imu));
  counters_.accepted_epochs.set(static_cast<std::int64_t>(sequencer.epochs));
  counters_.accepted_odometer.set(
      static_cast<std::int64_t>(sequencer.odometer - sequencer.late_odometer));
  counters_.late_odometer.set(static_cast<std::int64_t>(sequencer.late_odometer));
  counters_.odometer_age_ms.set(odometer_age_ms(sequencer_));
  counters_.empty_epochs.set(static_cast<std::int64_t>(sequencer.empty_epochs));
  counters_.late_epochs.set(static_cast<std::int64_t>(sequencer.late_epochs));
  counters_.epochs_without_imu.set(static_cast<std::int64_t>(sequencer.epochs_without_imu));
  counters_.imu_gaps.set(static_cast<std::int64_t>(sequencer.imu_gaps));
  counters_.imu_smoothed.set(static_cast<std::int64_t>(sequencer.imu_smoothed));
}

}  // namespace leonav
