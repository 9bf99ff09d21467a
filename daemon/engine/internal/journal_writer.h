// The JournalWriter writes the inputs and outputs of a run, in order, to the journal file.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "daemon/config/daemon_config.h"
#include "daemon/threads/counters.h"
#include "daemon/threads/message_ring.h"
#include "drivers/lcm/event_log.h"

namespace leonav {

// The first message holds the configuration of the run, the last one states that it was stopped
// cleanly. After an error nothing more is written: counters.journal_failed is set, error() holds
// the reason. Without a journal (no path configured) every call does nothing.
class JournalWriter {
 public:
  // `config`, `counters`: must outlive this object.
  JournalWriter(const DaemonConfig* config, EngineCounters* counters);

  // Creates the file and writes the configuration. Throws EventLogError if it cannot be created; a
  // file that exists is left alone, see claim_journal_path().
  void open();
  bool is_open() const { return log_ != nullptr; }
  // Until open() the configured path, then where the journal is written; empty: nowhere.
  const std::string& path() const { return path_; }

  // After open(): one thread. `sync`: on to the disk.
  void write(const MessageHeader& header, ByteSpan bytes);
  void flush(bool sync);
  // Writes the last message and flushes to the disk.
  void finish();

  // Any thread, once counters.journal_failed is set.
  const std::string& error() const { return error_; }

 private:
  void write_configuration();
  void write_end();

  const DaemonConfig* config_;
  std::string path_;
  EngineCounters* counters_;
  std::vector<std::string> channel_names_;
  std::unique_ptr<EventLogWriter> log_;
  std::string error_;
};

}  // namespace leonav
