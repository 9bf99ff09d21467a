// The CheckpointWriter keeps the checkpoint file up to date, in a thread of its own.
#pragma once
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "core/navigator/interface/checkpoint.h"
#include "daemon/checkpoint/product_store.h"
#include "daemon/checkpoint/products_file.h"
#include "daemon/config/daemon_config.h"
#include "daemon/threads/counters.h"
#include "daemon/threads/latest_value.h"
#include "daemon/threads/realtime_thread.h"

namespace leonav {

// The thread may wait for the disk. It writes at every interval, and at once where the vehicle has
// stopped or set off, so that the file after a power cut never states a moving vehicle as parked.
// Where there is no usable heading, the file stays while the vehicle stands, and is removed as soon
// as it moves. The products are written beside it, whether there is a heading or not.
class CheckpointWriter {
 public:
  explicit CheckpointWriter(const CheckpointConfig& config) : config_(config) {}
  ~CheckpointWriter() { finish(); }

  // Throws std::runtime_error if no thread can be made. Without a path nothing is ever written.
  void start();
  // One thread sets the newest checkpoint here, as often as it has one.
  LatestValue<Checkpoint>* latest() { return &latest_; }
  // One thread keeps broadcast products here, as they come.
  ProductStore* products() { return &products_; }
  // Writes the last one and ends the thread.
  void finish();
  // Why the last write failed; empty: it did not. Any thread.
  std::string error() const;

 private:
  void run();
  void write_if_due(bool at_end);
  void write_checkpoint_if_due(bool at_end);
  void write_products_if_due(bool at_end);

  CheckpointConfig config_;
  LatestValue<Checkpoint> latest_;
  ProductStore products_;
  RealtimeThread thread_;
  bool started_ = false;
  mutable std::mutex mutex_;  // protects stop_ and error_
  std::condition_variable wakeup_;
  bool stop_ = false;
  std::string error_;
  // Used by the thread and, after it has ended, by finish().
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

}  // namespace leonav
