#include "daemon/checkpoint/checkpoint_writer.h"

#include <chrono>
#include <utility>

#include "core/navigator/sequencer/input_validation.h"
#include "daemon/checkpoint/checkpoint_file.h"

namespace leonav {
namespace {

constexpr std::chrono::seconds kLook(1);

}  // namespace

void CheckpointWriter::start() {
  if (config_.path.empty()) return;
  thread_.start("file", ThreadConfig(), [this] { run(); });
  started_ = true;
}

void CheckpointWriter::finish() {
  if (!std::exchange(started_, false)) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wakeup_.notify_all();
  thread_.join();
  write_if_due(true);
}

std::string CheckpointWriter::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

void CheckpointWriter::run() {
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (wakeup_.wait_for(lock, kLook, [this] { return stop_; })) return;
    }
    write_if_due(false);
  }
}

void CheckpointWriter::write_if_due(bool at_end) {
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
