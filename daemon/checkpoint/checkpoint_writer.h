// The CheckpointWriter keeps the checkpoint file up to date, in a thread of its own.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "core/navigator/interface/checkpoint.h"
#include "daemon/checkpoint/product_store.h"
#include "daemon/config/daemon_config.h"
#include "daemon/threads/latest_value.h"

namespace leonav {

// Called before each write, for tests that let the disk wait. Empty in production.
using CheckpointHook = std::function<void()>;

// The thread may wait for the disk; nothing waits for the thread. It writes at every interval, and
// at once where the vehicle has stopped or set off, so that the file after a power cut never states
// a moving vehicle as parked. Where there is no usable heading, the file stays while the vehicle
// stands, and is removed as soon as it moves. The products are written beside it, whether there is
// a heading or not.
class CheckpointWriter {
 public:
  static constexpr double kLongestEnd_s = 3.0;

  explicit CheckpointWriter(const CheckpointConfig& config, CheckpointHook hook = {});
  ~CheckpointWriter();
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;

  // Throws std::runtime_error if no thread can be made. Without a path nothing is ever written.
  void start();
  // One thread sets the newest checkpoint here, as often as it has one.
  LatestValue<Checkpoint>* latest();
  // One thread keeps broadcast products here, as they come.
  ProductStore* products();
  // Lets the thread write the last one, and ends it. A thread that the disk holds is left to
  // itself after kLongestEnd_s.
  void finish();
  // Why the last write failed, or that it does not end; empty: neither. Any thread.
  std::string error() const;

 private:
  class State;

  std::unique_ptr<State> state_;
  bool has_file_ = false, is_running_ = false, abandoned_ = false;
};

}  // namespace leonav
