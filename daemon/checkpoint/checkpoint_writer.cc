#include "daemon/checkpoint/checkpoint_writer.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "core/navigator/sequencer/input_validation.h"
#include "daemon/checkpoint/checkpoint_file.h"
#include "daemon/checkpoint/internal/replace_file.h"
#include "daemon/checkpoint/products_file.h"
#include "daemon/threads/counters.h"
#include "daemon/threads/leave_to_process.h"
#include "daemon/threads/realtime_thread.h"
#include "daemon/threads/wall_clock.h"

namespace leonav {
namespace {

constexpr std::chrono::seconds kLook(1);
constexpr double kStalled_s = 2.0;  // error() tells of a write that takes longer

double seconds(const Stopwatch& watch) { return static_cast<double>(watch.nanoseconds()) * 1e-9; }

}  // namespace

// What the thread uses, which may outlive the writer.
class CheckpointWriter::State {
 public:
  State(const CheckpointConfig& config, CheckpointHook hook)
      : config_(config), hook_(std::move(hook)) {}

  void start();
  void ask_for_end();
  bool has_ended() const { return has_ended_.load(std::memory_order_acquire); }
  std::string error() const;
  std::string no_answer() const { return config_.path + ": the disk does not answer"; }

  LatestValue<Checkpoint> latest;
  ProductStore products;
  RealtimeThread thread;
  State* left_before = nullptr;

 private:
  void run();
  void write_if_due(bool at_end);
  void write_checkpoint_if_due(bool at_end);
  void write_products_if_due(bool at_end);
  // Calls `write`, noting since when; returns why it failed.
  template <typename Write>
  std::string call_disk(Write&& write);

  CheckpointConfig config_;
  CheckpointHook hook_;
  mutable std::mutex mutex_;  // protects stop_ and error_
  std::condition_variable wakeup_;
  bool stop_ = false;
  std::string error_;
  Gauge waiting_since_ns_;  // for the disk; 0: it does not
  std::atomic<bool> has_ended_{false};
  // Of the thread.
  Checkpoint newest_;
  bool unwritten_ = false;
  std::optional<Checkpoint> written_;
  BroadcastProducts newest_products_;
  bool unwritten_products_ = false;
  ProductsText products_text_;
  std::string products_path_, written_products_;
  std::string checkpoint_problem_, products_problem_;  // of the last attempt
  Stopwatch since_written_, since_products_written_;
};

void CheckpointWriter::State::start() {
  products_path_ = products_path(config_.path);
  newest_products_.ephemerides.reserve(ProductStore::kMostEphemerides);
  newest_products_.biases.reserve(ProductStore::kMostBiases);
  written_products_.reserve(ProductsText::kUsualBytes);
  thread.start(
      "file", ThreadConfig(), [this] { run(); }, RealtimeThread::kSmallStackBytes);
}

void CheckpointWriter::State::ask_for_end() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wakeup_.notify_all();
}

std::string CheckpointWriter::State::error() const {
  const std::int64_t since_ns = waiting_since_ns_.get();
  if (since_ns != 0 && static_cast<double>(monotonic_ns() - since_ns) * 1e-9 > kStalled_s)
    return no_answer();
  const std::lock_guard lock(mutex_);
  return error_;
}

void CheckpointWriter::State::run() {
  for (bool stop = false; !stop;) {
    {
      std::unique_lock lock(mutex_);
      stop = wakeup_.wait_for(lock, kLook, [this] { return stop_; });
    }
    write_if_due(stop);
  }
  has_ended_.store(true, std::memory_order_release);
}

void CheckpointWriter::State::write_if_due(bool at_end) {
  write_checkpoint_if_due(at_end);
  write_products_if_due(at_end);
  const std::lock_guard lock(mutex_);
  error_ = checkpoint_problem_.empty() ? products_problem_ : checkpoint_problem_;
}

template <typename Write>
std::string CheckpointWriter::State::call_disk(Write&& write) {
  waiting_since_ns_.set(monotonic_ns());
  if (hook_) hook_();
  std::string problem = write();
  waiting_since_ns_.set(0);
  return problem;
}

void CheckpointWriter::State::write_checkpoint_if_due(bool at_end) {
  unwritten_ = latest.take(&newest_) || unwritten_;
  if (!unwritten_) return;
  // What the next start would refuse must not cost the heading.
  if (newest_.calibration && check(*newest_.calibration) != InputFault::kNone)
    newest_.calibration.reset();
  if (check(newest_) == InputFault::kNone) {
    const bool changed = !written_ || written_->standing != newest_.standing;
    if (!at_end && !changed && seconds(since_written_) < config_.interval_s) return;
    checkpoint_problem_ = call_disk([this] { return save_checkpoint(config_.path, newest_); });
    if (checkpoint_problem_.empty()) written_ = newest_;
    since_written_ = Stopwatch();
  } else if (!newest_.standing) {
    checkpoint_problem_ = call_disk([this] { return remove_checkpoint(config_.path); });
    written_.reset();
  } else {
    checkpoint_problem_.clear();
  }
  unwritten_ = !checkpoint_problem_.empty();
}

// Senders repeat what has not changed, which is not written again.
void CheckpointWriter::State::write_products_if_due(bool at_end) {
  if (!at_end && seconds(since_products_written_) < config_.interval_s) return;
  unwritten_products_ = products.take(&newest_products_) || unwritten_products_;
  if (!unwritten_products_) return;
  since_products_written_ = Stopwatch();
  const std::string& text = products_text_.of(newest_products_);
  if (text != written_products_) {
    products_problem_ = call_disk([&] { return replace_file(products_path_, text); });
    if (products_problem_.empty()) written_products_ = text;
  }
  unwritten_products_ = !products_problem_.empty();
}

CheckpointWriter::CheckpointWriter(const CheckpointConfig& config, CheckpointHook hook)
    : state_(std::make_unique<State>(config, std::move(hook))), has_file_(!config.path.empty()) {}

// A thread that the disk holds goes on using its state, for as long as the process lives.
CheckpointWriter::~CheckpointWriter() {
  finish();
  if (abandoned_) leave_to_process(state_.release());
}

void CheckpointWriter::start() {
  if (!has_file_) return;
  state_->start();
  is_running_ = true;
}

LatestValue<Checkpoint>* CheckpointWriter::latest() { return &state_->latest; }

ProductStore* CheckpointWriter::products() { return &state_->products; }

void CheckpointWriter::finish() {
  if (!std::exchange(is_running_, false)) return;
  state_->ask_for_end();
  abandoned_ =
      !state_->thread.join_or_detach(kLongestEnd_s, [this] { return state_->has_ended(); });
}

std::string CheckpointWriter::error() const {
  return abandoned_ ? state_->no_answer() : state_->error();
}

}  // namespace leonav
