// The Journal takes the messages of a run without ever waiting, and writes them in its own thread.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "daemon/config/daemon_config.h"
#include "daemon/journal/journal_counters.h"
#include "daemon/threads/message_ring.h"

namespace leonav {

// Messages wait for the disk in memory of a fixed size (journal.buffer_mb). Where it is more than
// half full, SOLUTION is left out; where it is full, everything, until it is half empty. What is
// missing is counted, and a mark LOST stands in its place. The thread writes pieces
// (JournalWriter), and goes on after any failure of the disk.
//
// Without a journal (no path configured) every call does nothing.
class Journal {
 public:
  // `before_call`: for tests, see JournalFile.
  explicit Journal(const DaemonConfig& config, std::function<int()> before_call = {});
  // As finish().
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // Claims the first piece. Throws EventLogError if it cannot be created; a file that exists is
  // left alone, see claim_journal_path().
  void open();
  // After open(); throws std::runtime_error if no thread can be made.
  void start();
  bool is_open() const { return state_ != nullptr; }

  // One thread; never waits.
  void push(const MessageHeader& header, ByteSpan bytes);

  // After the last push(): writes what is left and the end mark. It waits kLongestEnd_s at most; a
  // thread that the disk still holds is then left to itself. False: the journal is incomplete.
  bool finish();
  static constexpr double kLongestEnd_s = 5.0;

  // Any thread: something is wrong with the navigation; the present piece and the one before it
  // are to be kept (journal.kept_mb).
  void keep();

  // Any thread, after open().
  const JournalCounters& counters() const;
  RingStatistics ring() const;
  // Where the first piece is; empty: there is no journal.
  const std::string& path() const { return path_; }
  // Why nothing is written at present, with the file; empty: it is.
  std::string failure() const;
  // Whether a call to the disk has not returned for seconds.
  bool is_stalled() const;
  // After finish(): why the journal is incomplete; empty: it is complete.
  std::string error() const;

 private:
  struct State;
  static void leave(State* state);
  void fail(const std::string& reason);
  void count_lost(Channel channel);
  bool push_lost_mark();

  DaemonConfig config_;
  std::function<int()> before_call_;
  std::string path_;
  JournalCounters none_;
  std::unique_ptr<State> state_;
  bool complete_ = true, abandoned_ = false;
  std::string error_;
};

}  // namespace leonav
