#include "daemon/journal/journal.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <utility>

#include "daemon/journal/internal/journal_name.h"
#include "daemon/journal/internal/journal_writer.h"
#include "daemon/journal/internal/kept_names.h"
#include "daemon/journal/internal/recorded_outputs.h"
#include "daemon/messages/output_selection.h"
#include "daemon/threads/leave_to_process.h"
#include "daemon/threads/realtime_thread.h"
#include "daemon/threads/wall_clock.h"
#include "drivers/lcm/event_log.h"

namespace leonav {
namespace {

constexpr std::int64_t kLookNs = 20'000'000;  // how often the thread looks for messages
constexpr std::int64_t kStalledNs = 2 * kNanosecondsPerSecond;
// Shares of the ring at which outputs begin and cease to be left out.
constexpr double kCrowded = 0.5, kRelaxed = 0.25;

// What no disk that comes back mends, at the start.
bool is_lasting(int error) {
  return error == ENOTDIR || error == EISDIR || error == ENAMETOOLONG || error == ELOOP ||
         error == EEXIST;
}

void sleep_ns(std::int64_t ns) {
  const timespec time{ns / kNanosecondsPerSecond, ns % kNanosecondsPerSecond};
  nanosleep(&time, nullptr);
}

}  // namespace

// What the thread uses.
struct Journal::State {
  State(const DaemonConfig& config, DiskHook hook)
      : ring(static_cast<std::size_t>(config.journal.buffer_mb * 1e6), &unused),
        selection(recorded_outputs(config.journal.outputs)),
        writer(config, &counters, &kept, std::move(hook)) {}

  void run() {
    for (;;) {
      const bool last = no_more.load(std::memory_order_acquire);
      if (last) break;
      writer.write_from(&ring);
      sleep_ns(kLookNs);
    }
    counters.complete.set(writer.finish(&ring, lost, marks + 1) ? 1 : 0);
    ended.store(true, std::memory_order_release);
  }

  JournalCounters counters;
  KeptNames kept;
  Wakeup unused;  // the thread looks by itself, so that who pushes makes no system call
  MessageRing ring;
  // Of who pushes; the thread reads `lost` and `marks` once there is nothing more.
  OutputSelection selection;
  LostMessages lost;  // since the last mark
  std::uint64_t marks = 0;
  bool leaves_out = false, is_full = false;
  std::atomic<bool> no_more{false}, ended{false};
  JournalWriter writer;
  RealtimeThread thread;
  State* left_before = nullptr;
};

Journal::Journal(const DaemonConfig& config, DiskHook hook)
    : config_(config), hook_(std::move(hook)) {}

// A thread that the disk holds goes on using its state, for as long as the process lives.
Journal::~Journal() {
  finish();
  if (abandoned_) leave_to_process(state_.release());
}

void Journal::open() {
  if (config_.journal.path.empty()) return;
  auto state = std::make_unique<State>(config_, hook_);
  // Never real-time: it waits for the disk.
  state->thread.start(
      "journal", ThreadConfig(), [state = state.get()] { state->run(); },
      RealtimeThread::kSmallStackBytes);
  state_ = std::move(state);
  const JournalCounters& counters = state_->counters;
  const Stopwatch watch;
  while (!has_file() && counters.last_error.get() == 0 &&
         static_cast<double>(watch.nanoseconds()) * 1e-9 < kLongestOpening_s)
    sleep_ns(1'000'000);
  const auto error = static_cast<int>(counters.last_error.get());
  if (has_file() || !is_lasting(error)) return;
  finish();
  throw EventLogError(path() +
                      (error == EEXIST
                           ? ": exists, and so do .1 to ." + std::to_string(kMostNumberedJournals) +
                                 "; move the journals away"
                           : std::string(": cannot be created: ") + std::strerror(error)));
}

void Journal::push(const MessageHeader& header, ByteSpan bytes) {
  if (state_ == nullptr) return;
  State& state = *state_;
  const RecordedOutputs wanted = state.writer.wanted_outputs();
  if (wanted != state.selection.outputs()) select(wanted);
  if (!state.selection.contains(header.channel, bytes)) return;
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

// Where there is no room for the mark, the next message tries again.
void Journal::select(RecordedOutputs outputs) {
  const auto mark = static_cast<std::uint8_t>(outputs);
  if (state_->ring.try_push(Channel::kPiece, 0, {&mark, 1}))
    state_->selection = OutputSelection(outputs);
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
  if (state_ == nullptr || state_->no_more.load()) return complete_;
  state_->no_more.store(true, std::memory_order_release);
  abandoned_ = !state_->thread.join_or_detach(
      kLongestEnd_s, [this] { return state_->ended.load(std::memory_order_acquire); });
  if (abandoned_) {
    fail(path() + ": the disk has not taken the end of the journal");
    return complete_;
  }
  const std::int64_t lost = state_->counters.lost_others.get();
  if (state_->counters.complete.get() == 0) {
    const std::string reason = failure();
    fail(reason.empty() ? path() + ": cannot be written" : reason);
  } else if (lost > 0) {
    fail(path() + ": " + std::to_string(lost) +
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

void Journal::set_limits(const JournalLimits& limits) {
  if (state_ != nullptr) state_->writer.set_limits(limits);
}

const JournalCounters& Journal::counters() const {
  return state_ == nullptr ? none_ : state_->counters;
}

RingStatistics Journal::ring() const {
  return state_ == nullptr ? RingStatistics() : state_->ring.statistics();
}

std::string Journal::path() const {
  const std::int64_t number = counters().name.get() - 1;
  return config_.journal.path + (number > 0 ? "." + std::to_string(number) : "");
}

std::optional<std::string> Journal::take_kept() {
  if (state_ == nullptr) return std::nullopt;
  const auto name = state_->kept.take();
  if (!name) return std::nullopt;
  return std::filesystem::path(config_.journal.path).replace_filename(*name).string();
}

std::string Journal::failure() const { return text_of(counters().error.get()); }

std::string Journal::last_failure() const { return text_of(counters().last_error.get()); }

std::string Journal::text_of(std::int64_t error) const {
  if (error == 0) return {};
  return path() + ": cannot be written: " + std::strerror(static_cast<int>(error));
}

bool Journal::is_stalled() const {
  if (state_ == nullptr) return false;
  const std::int64_t since = state_->counters.waiting_since_ns.get();
  return since != 0 && monotonic_ns() - since > kStalledNs;
}

std::string Journal::error() const { return error_; }

}  // namespace leonav
