// EventLogReader and EventLogWriter read and write LCM event logs and report every error.
//
// The class lcm::LogFile of liblcm ends silently where a log is damaged and ignores a full disk
// when writing; a journal must report both.
//
// Format (LCM documentation, "Log file format"), big endian: sync word 0xEDA1DA01, event number
// (8 bytes), timestamp in microseconds (8), channel length (4), data length (4), channel, data.
#pragma once
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace leonav {

// EventLogError names the file, for damage the byte, and the error.
class EventLogError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// One event of a log: a message on a channel.
struct LogEvent {
  std::int64_t number = 0;  // counts the events of the log, from 0
  std::int64_t timestamp_us = 0;
  std::string channel;
  std::vector<std::uint8_t> data;
};

// FileCloser closes the file of a FileHandle.
struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, FileCloser>;

// EventLogReader reads a log event by event.
class EventLogReader {
 public:
  // Throws EventLogError if the file cannot be opened or is empty.
  explicit EventLogReader(const std::string& path);

  // Reads the next event and returns true, or false at the end. Throws EventLogError with the byte
  // where the log is damaged. A last event that is cut short, as by a power failure, is the end;
  // truncated() is then true.
  bool next(LogEvent* event);

  bool truncated() const { return truncated_; }
  // These return the size of the file and the end of the last event read. The size of a pipe is
  // unknown: the largest integer.
  std::int64_t size_bytes() const { return size_; }
  std::int64_t position_bytes() const { return position_; }

 private:
  [[noreturn]] void damaged(const std::string& what) const;

  std::string path_;
  FileHandle file_;
  std::int64_t size_ = 0, position_ = 0;
  bool truncated_ = false;
};

// EventLogWriter writes a log and keeps the first error.
class EventLogWriter {
 public:
  // Throws EventLogError if the file cannot be created.
  explicit EventLogWriter(const std::string& path);

  // Writes an event. Returns false once writing has failed, for instance on a full disk; error()
  // gives the reason.
  bool write(std::int64_t timestamp_us, std::string_view channel,
             std::span<const std::uint8_t> data);
  // Passes everything to the operating system and, with `sync`, waits until it is on the disk.
  bool flush(bool sync = false);
  const std::string& error() const { return error_; }
  // Returns the number of events written.
  std::int64_t events() const { return next_number_; }

 private:
  bool fail();

  std::string path_;
  FileHandle file_;
  std::int64_t next_number_ = 0;
  std::string error_;
};

}  // namespace leonav
