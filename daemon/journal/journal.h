// The Journal takes the messages of a run without ever waiting, and writes them in its own thread.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "daemon/config/daemon_config.h"
#include "daemon/journal/disk_call.h"
#include "daemon/journal/journal_counters.h"
#include "daemon/journal/journal_limits.h"
#include "daemon/threads/message_ring.h"
#include "drivers/lcm/journal_marks.h"

namespace leonav {

// Messages wait for the disk in memory of a fixed size (journal.buffer_mb). Where it is more than
// half full, SOLUTION is left out; where it is full, everything, until it is half empty. What is
// missing is counted, and a mark LOST stands in its place. The thread writes pieces
// (JournalWriter), and goes on after any failure of the disk.
//
// Without a journal (no path configured) every call does nothing.
class Journal {
 public:
  // `hook`: for tests, see DiskCall.
  explicit Journal(const DaemonConfig& config, DiskHook hook = {});
  // As finish().
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // Starts the thread, which finds the folder, tidies it and begins the first piece; a file that
  // exists is left alone, see claim_journal(). Whatever the disk does, this waits
  // kLongestOpening_s at most, and the journal begins as soon as that can be done. Throws
  // EventLogError if it has turned out meanwhile that the path can never be written, and
  // std::runtime_error if no thread can be made.
  void open();
  static constexpr double kLongestOpening_s = 1.0;
  bool is_open() const { return state_ != nullptr; }

  // One thread; never waits.
  void push(const MessageHeader& header, ByteSpan bytes);

  // After open() and the last push(): writes what is left and the end mark. It waits kLongestEnd_s
  // at most; a thread that the disk still holds is then left to itself. False: the journal is
  // incomplete.
  bool finish();
  static constexpr double kLongestEnd_s = 5.0;

  // Any thread: something is wrong with the navigation; the present piece and the one before it
  // are to be kept (journal.kept_mb).
  void keep();
  // One thread, after open(): these limits hold from now on, for the piece that is written too.
  // Other outputs begin a piece; a pipe or a device, which has no pieces, goes on with those of its
  // start.
  void set_limits(const JournalLimits& limits);

  // Any thread, after open().
  const JournalCounters& counters() const;
  RingStatistics ring() const;
  // Where the first piece is, or until has_file(), where it is to be; empty: there is no journal.
  std::string path() const;
  bool has_file() const { return counters().name.get() > 0; }
  // One thread: the path under which a piece was kept, each once; nullopt: there is no other.
  std::optional<std::string> take_kept();
  // Why nothing is written at present, with the file; empty: it is.
  std::string failure() const;
  // The same of the last failure, though it may be over.
  std::string last_failure() const;
  // Whether a call to the disk has not returned for seconds.
  bool is_stalled() const;
  // After finish(): why the journal is incomplete; empty: it is complete.
  std::string error() const;

 private:
  struct State;
  void select(RecordedOutputs outputs);
  void fail(const std::string& reason);
  std::string text_of(std::int64_t error) const;
  void count_lost(Channel channel);
  bool push_lost_mark();

  DaemonConfig config_;
  DiskHook hook_;
  JournalCounters none_;
  std::unique_ptr<State> state_;
  bool complete_ = true, abandoned_ = false;
  std::string error_;
};

}  // namespace leonav
