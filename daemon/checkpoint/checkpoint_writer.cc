#include "daemon/checkpoint/checkpoint_writer.h"

#include <chrono>
#include <utility>

#include "core/navigator/sequencer/input_validation.h"
#include "daemon/checkpoint/checkpoint_file.h"
#include "daemon/checkpoint/internal/replace_file.h"
#include "daemon/checkpoint/products_file.h"

namespace leonav {
namespace {

constexpr std::chrono::seconds kLook(1);

double seconds(const Stopwatch& watch) { return static_cast<double>(watch.nanoseconds()) * 1e-9; }

}  // namespace

void CheckpointWriter::start() {
  if (config_.path.empty()) return;
  products_path_ = products_path(config_.path);
  newest_products_.ephemerides.reserve(ProductStore::kMostEphemerides);
  newest_products_.biases.reserve(ProductStore::kMostBiases);
  written_products_.reserve(ProductsText::kUsualBytes);
  thread_.start(
      "file", ThreadConfig(), [this] { run(); }, RealtimeThread::kSmallStackBytes);
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
  write_checkpoint_if_due(at_end);
  write_products_if_due(at_end);
  const std::lock_guard lock(mutex_);
  error_ = checkpoint_problem_.empty() ? products_problem_ : checkpoint_problem_;
}

void CheckpointWriter::write_checkpoint_if_due(bool at_end) {
  unwritten_ = latest_.take(&newest_) || unwritten_;
  if (!unwritten_) return;
  // What the next start would refuse must not cost the heading.
  if (newest_.calibration && check(*newest_.calibration) != InputFault::kNone)
    newest_.calibration.reset();
  if (check(newest_) == InputFault::kNone) {
    const bool changed = !written_ || written_->standing != newest_.standing;
    if (!at_end && !changed && seconds(since_written_) < config_.interval_s) return;
    checkpoint_problem_ = save_checkpoint(config_.path, newest_);
    if (checkpoint_problem_.empty()) written_ = newest_;
    since_written_ = Stopwatch();
  } else if (!newest_.standing) {
    checkpoint_problem_ = remove_checkpoint(config_.path);
    written_.reset();
  } else {
    checkpoint_problem_.clear();
  }
  unwritten_ = !checkpoint_problem_.empty();
}

// Senders repeat what has not changed, which is not written again.
void CheckpointWriter::write_products_if_due(bool at_end) {
  if (!at_end && seconds(since_products_written_) < config_.interval_s) return;
  unwritten_products_ = products_.take(&newest_products_) || unwritten_products_;
  if (!unwritten_products_) return;
  since_products_written_ = Stopwatch();
  const std::string& text = products_text_.of(newest_products_);
  if (text != written_products_) {
    products_problem_ = replace_file(products_path_, text);
    if (products_problem_.empty()) written_products_ = text;
  }
  unwritten_products_ = !products_problem_.empty();
}

}  // namespace leonav
