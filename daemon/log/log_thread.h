// The LogThread writes lines to standard error, and lets nobody who has a line wait for its reader.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace leonav {

// Whoever reads the lines may have stopped: a pipe that is full, a journald that is stuck, a file
// on a disk that is full or does not answer. A thread of its own writes what write() puts into a
// queue. What finds no room there is dropped and counted, and so is all that follows until the
// thread has written the queue and said so ("log: 12 lines lost"). So the lines are in order.
//
// Before start() and after finish() there is no thread, and write() itself waits a moment at most.
class LogThread {
 public:
  static constexpr std::size_t kQueueBytes = 64 << 10;  // some 700 lines
  static constexpr double kLongestEnd_s = 2.0;

  // `name` begins the line about lost ones, as it begins the others.
  LogThread(int descriptor, std::string name);
  ~LogThread();
  LogThread(const LogThread&) = delete;
  LogThread& operator=(const LogThread&) = delete;

  // Throws std::runtime_error if no thread can be made. It allocates nothing, has no priority, and
  // takes no signal.
  void start();
  // A line with its end. One thread at a time. Allocates nothing.
  void write(std::string_view line);
  // Lets the thread write what is there, and ends it. A thread that the reader holds is left to
  // itself after kLongestEnd_s, and later lines are dropped.
  void finish();
  // Since construction.
  std::uint64_t lost() const;

 private:
  class State;

  void write_directly(std::string_view line);

  std::unique_ptr<State> state_;
  bool is_running_ = false, abandoned_ = false;
};

}  // namespace leonav
