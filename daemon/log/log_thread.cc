#include "daemon/log/log_thread.h"

#include <pthread.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <utility>

#include "daemon/log/descriptor_write.h"
#include "daemon/threads/leave_to_process.h"
#include "daemon/threads/realtime_thread.h"
#include "daemon/threads/wakeup.h"

namespace leonav {
namespace {

constexpr std::size_t kPartBytes = 4096;  // that are written at once
constexpr std::size_t kNoteBytes = 128;   // of the line about lost ones
constexpr int kLongestDirectWait_ms = 200;

}  // namespace

// What the thread uses, which may outlive the writer.
class LogThread::State {
 public:
  State(int of_log, std::string name);

  void start();
  void push(std::string_view line);
  void drop_lines(std::uint64_t count);
  void ask_for_end();
  bool has_ended() const { return has_ended_.load(std::memory_order_acquire); }
  std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }
  // Both write by `write`, which returns what it could not write.
  // A line about those that were lost since the last one, if any were. Returns whether it is
  // written; where not, they are told later.
  template <typename Write>
  bool tell_lost(Write write);
  // Returns what is not written. A line that was torn before gets its end first.
  template <typename Write>
  std::string_view write_on(std::string_view text, Write write);
  bool has_untold() const { return untold_.load(std::memory_order_acquire) > 0; }

  int descriptor;
  bool is_blocked = false;  // at the last direct write
  RealtimeThread thread;
  State* left_before = nullptr;

 private:
  void run();
  auto whole() const {
    return [this](std::string_view text) { return write_whole(descriptor, text); };
  }
  void write_part(std::string_view part);
  std::string_view note(std::uint64_t count);

  std::string name_;
  boost::lockfree::spsc_queue<char> queue_{kQueueBytes};
  Wakeup wakeup_;
  std::atomic<std::uint64_t> lost_{0}, untold_{0};
  std::atomic<bool> stop_{false}, has_ended_{false};
  std::array<char, kPartBytes> part_{};
  std::array<char, kNoteBytes> note_{};
  // What is written ends within a line; the rest of that line was refused; what comes next in the
  // queue is the rest of a line whose beginning was refused.
  bool in_line_ = false, is_torn_ = false, skips_to_end_ = false;
};

LogThread::State::State(int of_log, std::string name) : descriptor(of_log), name_(std::move(name)) {
  tzset();  // it allocates
  // Every page is touched once, so that the process does not grow as the queue goes round.
  while (queue_.push(part_.data(), part_.size()) > 0) {
  }
  queue_.reset();
}

// Signals are for `main`, and a pipe without a reader must be the failure of a write.
void LogThread::State::start() {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    thread.start(
        "log", ThreadConfig(), [this] { run(); }, RealtimeThread::kSmallStackBytes);
  } catch (...) {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void LogThread::State::push(std::string_view line) {
  if (has_untold() || queue_.write_available() < line.size())
    drop_lines(1);
  else
    queue_.push(line.data(), line.size());
  wakeup_.notify();
}

void LogThread::State::drop_lines(std::uint64_t count) {
  lost_.fetch_add(count, std::memory_order_relaxed);
  untold_.fetch_add(count, std::memory_order_release);
}

void LogThread::State::ask_for_end() {
  stop_.store(true, std::memory_order_release);
  wakeup_.notify();
}

template <typename Write>
bool LogThread::State::tell_lost(Write write) {
  const std::uint64_t count = untold_.exchange(0, std::memory_order_acq_rel);
  if (count == 0 || write_on(note(count), write).empty()) return true;
  untold_.fetch_add(count, std::memory_order_release);
  return false;
}

template <typename Write>
std::string_view LogThread::State::write_on(std::string_view text, Write write) {
  if (is_torn_) {
    if (!write("\n").empty()) return text;
    in_line_ = is_torn_ = false;
  }
  const std::string_view rest = write(text);
  if (rest.size() < text.size()) in_line_ = text[text.size() - rest.size() - 1] != '\n';
  is_torn_ = !rest.empty() && in_line_;
  return rest;
}

std::string_view LogThread::State::note(std::uint64_t count) {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  tm local{};
  localtime_r(&now.tv_sec, &local);
  const int size = std::snprintf(note_.data(), note_.size(),
                                 "%.60s %02d:%02d:%02d.%03d warning: log: %llu line%s lost\n",
                                 name_.c_str(), local.tm_hour, local.tm_min, local.tm_sec,
                                 static_cast<int>(now.tv_nsec / 1'000'000),
                                 static_cast<unsigned long long>(count), count == 1 ? "" : "s");
  return {note_.data(), static_cast<std::size_t>(size)};
}

// Counts the lines of which not all was written.
void LogThread::State::write_part(std::string_view part) {
  if (skips_to_end_) {
    const std::size_t end = part.find('\n');
    if (end == part.npos) return;
    part.remove_prefix(end + 1);
    skips_to_end_ = false;
    drop_lines(1);
  }
  const std::string_view rest = write_on(part, whole());
  if (rest.empty()) return;
  skips_to_end_ = rest.back() != '\n';
  drop_lines(static_cast<std::uint64_t>(std::count(rest.begin(), rest.end(), '\n')));
}

// Where the system refuses even the line about those that were lost, it is tried again as the next
// line comes, and that one is dropped.
void LogThread::State::run() {
  for (;;) {
    const std::uint32_t ticket = wakeup_.ticket();
    // Read before looking for lines, so that what was pushed before it was set is still written.
    const bool last_round = stop_.load(std::memory_order_acquire);
    if (const std::size_t size = queue_.pop(part_.data(), part_.size()); size > 0) {
      write_part({part_.data(), size});
    } else if (has_untold() && tell_lost(whole())) {
      continue;
    } else if (last_round) {
      has_ended_.store(true, std::memory_order_release);
      return;
    } else {
      wakeup_.wait(ticket);
    }
  }
}

LogThread::LogThread(int descriptor, std::string name)
    : state_(std::make_unique<State>(descriptor, std::move(name))) {}

// A thread that its reader holds goes on using its state, for as long as the process lives.
LogThread::~LogThread() {
  finish();
  if (abandoned_) leave_to_process(state_.release());
}

void LogThread::start() {
  if (is_running_ || abandoned_) return;
  state_->start();
  is_running_ = true;
}

void LogThread::write(std::string_view line) {
  if (is_running_)
    state_->push(line);
  else if (abandoned_)
    state_->drop_lines(1);
  else
    write_directly(line);
}

// Once nobody has read for a moment, the next lines are not waited for.
void LogThread::write_directly(std::string_view line) {
  const int longest_ms = state_->is_blocked ? 0 : kLongestDirectWait_ms;
  state_->is_blocked = !wait_for_room(state_->descriptor, longest_ms);
  const auto write = [&](std::string_view text) {
    return write_where_there_is_room(state_->descriptor, text, longest_ms);
  };
  if (!state_->is_blocked)
    state_->is_blocked = !state_->tell_lost(write) || !state_->write_on(line, write).empty();
  if (state_->is_blocked) state_->drop_lines(1);
}

void LogThread::finish() {
  if (!std::exchange(is_running_, false)) return;
  state_->ask_for_end();
  abandoned_ =
      !state_->thread.join_or_detach(kLongestEnd_s, [this] { return state_->has_ended(); });
}

std::uint64_t LogThread::lost() const { return state_->lost(); }

}  // namespace leonav
