#include "daemon/journal/journal.h"

#include <atomic>
#include <cstring>
#include <ctime>
#include <utility>

#include "daemon/journal/internal/journal_writer.h"
#include "daemon/journal/internal/output_selection.h"
#include "daemon/threads/realtime_thread.h"
#include "daemon/threads/wall_clock.h"

namespace leonav {
namespace {

constexpr std::int64_t kLookNs = 20'000'000;  // how often the thread looks for messages
constexpr std::int64_t kStalledNs = 2 * kNanosecondsPerSecond;
constexpr std::size_t kStackBytes = 256 << 10;
// Shares of the ring at which outputs begin and cease to be left out.
constexpr double kCrowded = 0.5, kRelaxed = 0.25;

void sleep_ns(std::int64_t ns) {
  const timespec time{ns / kNanosecondsPerSecond, ns % kNanosecondsPerSecond};
  nanosleep(&time, nullptr);
}

}  // namespace

// What the thread uses.
struct Journal::State {
  State(const DaemonConfig& config, std::function<int()> before_call)
      : ring(static_cast<std::size_t>(config.journal.buffer_mb * 1e6), &unused),
        selection(config.journal.outputs),
        writer(config, &counters, std::move(before_call)) {}

  void run() {
    for (;;) {
      const bool last = no_more.load(std::memory_order_acquire);
      if (last) break;
      writer.write_from(&ring);
      sleep_ns(kLookNs);
    }
    counters.complete.set(writer.finish(&ring, lost) ? 1 : 0);
    ended.store(true, std::memory_order_release);
  }

  JournalCounters counters;
  Wakeup unused;  // the thread looks by itself, so that who pushes makes no system call
  MessageRing ring;
  // Of who pushes; the thread reads `lost` once there is nothing more.
  OutputSelection selection;
  LostMessages lost;  // since the last mark
  std::uint64_t marks = 0;
  bool leaves_out = false, is_full = false;
  std::atomic<bool> no_more{false}, ended{false};
  JournalWriter writer;
  RealtimeThread thread;
  bool started = false;
  State* left_before = nullptr;
};

Journal::Journal(const DaemonConfig& config, std::function<int()> before_call)
    : config_(config), before_call_(std::move(before_call)), path_(config.journal.path) {}

// A thread that the disk holds goes on using its state, for as long as the process lives.
Journal::~Journal() {
  finish();
  if (abandoned_) leave(state_.release());
}

// Keeps it within reach, so that it is no leak.
void Journal::leave(State* state) {
  static std::atomic<State*> last{nullptr};
  state->left_before = last.exchange(state);
}

void Journal::open() {
  if (config_.journal.path.empty()) return;
  auto state = std::make_unique<State>(config_, before_call_);
  state->writer.open();
  path_ = state->writer.path();
  state_ = std::move(state);
}

void Journal::start() {
  if (state_ == nullptr) return;
  // Never real-time: it waits for the disk.
  state_->thread.start(
      "journal", ThreadConfig(), [state = state_.get()] { state->run(); }, kStackBytes);
  state_->started = true;
}

void Journal::push(const MessageHeader& header, ByteSpan bytes) {
  if (state_ == nullptr || !state_->selection.contains(header.channel, bytes)) return;
  State& state = *state_;
  const double fill = state.ring.fill();
  if (state.is_full && fill > kCrowded) return count_lost(header.channel);
  state.is_full = false;
  state.leaves_out = fill > (state.leaves_out ? kRelaxed : kCrowded);
  if (state.leaves_out && header.channel == Channel::kSolution) return count_lost(header.channel);
  // A mark stands before the first message of those that were left out is written again.
  const bool resumes = state.lost.others > 0 || header.channel == Channel::kSolution;
  if (state.lost.any() && resumes && !push_lost_mark()) return count_lost(header.channel);
  if (!state.ring.try_push(header.channel, header.timestamp_us, bytes)) {
    state.is_full = true;
    count_lost(header.channel);
  }
}

void Journal::count_lost(Channel channel) {
  const bool solution = channel == Channel::kSolution;
  ++(solution ? state_->lost.solutions : state_->lost.others);
  (solution ? state_->counters.lost_solutions : state_->counters.lost_others).add(1);
}

bool Journal::push_lost_mark() {
  const auto mark = encode_lost(state_->lost, ++state_->marks);
  if (!state_->ring.try_push(Channel::kLost, wall_clock_us(), mark)) {
    --state_->marks;
    state_->is_full = true;
    return false;
  }
  state_->lost = {};
  return true;
}

bool Journal::finish() {
  if (state_ == nullptr || !state_->started || state_->no_more.load()) return complete_;
  state_->no_more.store(true, std::memory_order_release);
  const Stopwatch watch;
  while (!state_->ended.load(std::memory_order_acquire) &&
         static_cast<double>(watch.nanoseconds()) * 1e-9 < kLongestEnd_s)
    sleep_ns(1'000'000);
  if (!state_->ended.load(std::memory_order_acquire)) {
    abandoned_ = true;
    state_->thread.detach();
    fail(path_ + ": the disk has not taken the end of the journal");
    return complete_;
  }
  state_->thread.join();
  const std::int64_t lost = state_->counters.lost_others.get();
  if (state_->counters.complete.get() == 0) {
    const std::string reason = failure();
    fail(reason.empty() ? path_ + ": cannot be written" : reason);
  } else if (lost > 0) {
    fail(path_ + ": " + std::to_string(lost) +
         " messages are missing, which the disk did not take in time");
  }
  return complete_;
}

void Journal::fail(const std::string& reason) {
  complete_ = false;
  error_ = reason;
}

void Journal::keep() {
  if (state_ != nullptr) state_->writer.keep();
}

const JournalCounters& Journal::counters() const {
  return state_ == nullptr ? none_ : state_->counters;
}

RingStatistics Journal::ring() const {
  return state_ == nullptr ? RingStatistics() : state_->ring.statistics();
}

std::string Journal::failure() const {
  if (state_ == nullptr) return {};
  const auto error = static_cast<int>(state_->counters.error.get());
  if (error == 0) return {};
  return path_ + ": cannot be written: " + std::strerror(error);
}

bool Journal::is_stalled() const {
  if (state_ == nullptr) return false;
  const std::int64_t since = state_->counters.waiting_since_ns.get();
  return since != 0 && monotonic_ns() - since > kStalledNs;
}

std::string Journal::error() const { return error_; }

}  // namespace leonav
