// LCM event logs, as lcm-logger writes them, are read and written here with every error reported.
//
// lcm::LogFile ends silently where a log is damaged, and ignores a full disk when writing; a
// journal must report both.
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

class EventLogError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct LogEvent {
  std::int64_t number = 0;
  std::int64_t timestamp_us = 0;
  std::string channel;
  std::vector<std::uint8_t> data;
};

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, FileCloser>;

class EventLogReader {
 public:
  // Throws EventLogError if the file cannot be opened or is empty.
  explicit EventLogReader(const std::string& path);

  // False at the end. Throws EventLogError, naming the byte, where the log is damaged. A last event
  // that is cut short, as by a power cut, is the end; truncated() is then true.
  bool next(LogEvent* event);

  bool truncated() const { return truncated_; }
  std::int64_t size_bytes() const { return size_; }
  std::int64_t position_bytes() const { return position_; }

 private:
  [[noreturn]] void damaged(const std::string& what) const;

  std::string path_;
  FileHandle file_;
  std::int64_t size_ = 0, position_ = 0;
  bool truncated_ = false;
};

class EventLogWriter {
 public:
  // Throws EventLogError if the file cannot be created.
  explicit EventLogWriter(const std::string& path);

  // False once writing has failed (disk full, ...): see error().
  bool write(std::int64_t timestamp_us, std::string_view channel,
             std::span<const std::uint8_t> data);
  // Passes everything to the operating system; `sync`: waits until it is on the disk.
  bool flush(bool sync = false);
  const std::string& error() const { return error_; }
  std::int64_t events() const { return next_number_; }

 private:
  bool fail();

  std::string path_;
  FileHandle file_;
  std::int64_t next_number_ = 0;
  std::string error_;
};

}  // namespace leonav
