#include "daemon/checkpoint_keeper.h"

#include <chrono>
#include <utility>

#include "core/navigator/input_checks.h"
#include "daemon/checkpoint_file.h"

namespace leonav {
namespace {

constexpr std::chrono::seconds kLook(1);

}  // namespace

void CheckpointKeeper::start() {
  if (config_.path.empty()) return;
  thread_.start("file", ThreadConfig(), [this] { run(); });
  started_ = true;
}

void CheckpointKeeper::finish() {
  if (!std::exchange(started_, false)) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wakeup_.notify_all();
  thread_.join();
  keep(true);
}

std::string CheckpointKeeper::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

void CheckpointKeeper::run() {
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (wakeup_.wait_for(lock, kLook, [this] { return stop_; })) return;
    }
    keep(false);
  }
}

void CheckpointKeeper::keep(bool at_end) {
  unwritten_ = latest_.take(&newest_) || unwritten_;
  if (!unwritten_) return;
  std::string problem;
  if (check(newest_) == InputFault::kNone) {
    const bool changed = !written_ || written_->standing != newest_.standing;
    const double passed_s = static_cast<double>(since_written_.nanoseconds()) * 1e-9;
    if (!at_end && !changed && passed_s < config_.interval_s) return;
    problem = save_checkpoint(config_.path, newest_);
    if (problem.empty()) written_ = newest_;
    since_written_ = Stopwatch();
  } else if (!newest_.standing) {
    problem = remove_checkpoint(config_.path);
    written_.reset();
  }
  unwritten_ = !problem.empty();
  const std::lock_guard lock(mutex_);
  error_ = problem;
}

}  // namespace leonav
