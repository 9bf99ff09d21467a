// Keeps the checkpoint's file up to date, in a thread that may wait for the disk.
#pragma once
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "core/navigator/checkpoint.h"
#include "daemon/config/daemon_config.h"
#include "daemon/counters.h"
#include "daemon/latest_value.h"
#include "daemon/realtime_thread.h"

namespace leonav {

// Every interval, and at once where the vehicle has stopped or set off: what a power cut leaves
// must not call a moving vehicle parked. Where there is no heading worth keeping the file stays as
// it is while the vehicle stands, and goes as soon as it moves: then what it says holds no longer.
class CheckpointKeeper {
 public:
  explicit CheckpointKeeper(const CheckpointConfig& config) : config_(config) {}
  ~CheckpointKeeper() { finish(); }

  // Throws std::runtime_error if no thread can be made. Without a path nothing is ever written.
  void start();
  // Where one thread, as often as it likes, tells how things are.
  LatestValue<Checkpoint>* latest() { return &latest_; }
  // After the last of them, which is written.
  void finish();
  // What last kept it from writing; empty: nothing. Any thread.
  std::string error() const;

 private:
  void run();
  void keep(bool at_end);

  CheckpointConfig config_;
  LatestValue<Checkpoint> latest_;
  RealtimeThread thread_;
  bool started_ = false;
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable wakeup_;
  bool stop_ = false;
  std::string error_;
  // Of the thread; after it has ended, of finish().
  Checkpoint newest_;
  bool unwritten_ = false;
  std::optional<Checkpoint> written_;
  Stopwatch since_written_;
};

}  // namespace leonav
