// A DiskReading reads from a disk that may not answer, in a thread of its own, for who must not
// wait.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "daemon/threads/leave_to_process.h"
#include "daemon/threads/realtime_thread.h"

namespace leonav {

// One at a time. The thread is there only while it reads, because reading allocates. Its stack is
// large enough for YAML, of which yaml-cpp takes 500 levels.
template <typename Result>
class DiskReading {
 public:
  static constexpr double kLongestEnd_s = 1.0;

  // `read` throws nothing, and uses nothing but what it holds itself: it may outlive this object.
  explicit DiskReading(std::function<Result()> read) : read_(std::move(read)) {}
  // A thread that the disk holds longer than kLongestEnd_s is left to itself.
  ~DiskReading() { wait(kLongestEnd_s); }
  DiskReading(const DiskReading&) = delete;
  DiskReading& operator=(const DiskReading&) = delete;

  // Throws std::runtime_error if no thread can be made.
  void begin() {
    auto state = std::make_unique<State>(read_);
    // Never real-time: it waits for the disk.
    state->thread.start("read", ThreadConfig(), [state = state.get()] { state->run(); });
    state_ = std::move(state);
  }
  bool is_under_way() const { return state_ != nullptr; }

  // Never waits: what was read, once; nullopt: it is not there yet, or nothing is under way.
  std::optional<Result> take() {
    if (!is_under_way() || !state_->has_ended()) return std::nullopt;
    return wait(0.0);
  }

  // Waits so long at most. nullopt: what would have come is given up.
  std::optional<Result> wait(double longest_s) {
    if (!is_under_way()) return std::nullopt;
    auto state = std::exchange(state_, nullptr);
    if (state->thread.join_or_detach(longest_s, [&state] { return state->has_ended(); }))
      return std::move(state->result);
    leave_to_process(state.release());
    return std::nullopt;
  }

 private:
  // What the thread uses, which may outlive the reading.
  struct State {
    explicit State(std::function<Result()> what) : read(std::move(what)) {}
    void run() {
      result = read();
      ended.store(true, std::memory_order_release);
    }
    bool has_ended() const { return ended.load(std::memory_order_acquire); }

    std::function<Result()> read;
    std::optional<Result> result;
    std::atomic<bool> ended{false};
    RealtimeThread thread;
    State* left_before = nullptr;
  };

  std::function<Result()> read_;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
