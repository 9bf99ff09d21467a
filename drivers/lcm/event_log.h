// EventLogReader and EventLogWriter read and write LCM event logs and report every error.
//
// The class lcm::LogFile of liblcm ends silently where a log is damaged and ignores a full disk
// when writing; a journal must report both.
// event_header.h has the format.
#pragma once
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/lcm/journal_marks.h"

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

// EventFileReader reads one file event by event.
class EventFileReader {
 public:
  // Throws EventLogError if the file cannot be opened or is empty.
  explicit EventFileReader(const std::string& path);

  // Reads the next event and returns true, or false at the end. Throws EventLogError with the byte
  // where the log is damaged. A last event that is cut short, as by a power failure, is the end;
  // truncated() is then true.
  bool next(LogEvent* event);

  bool truncated() const { return truncated_; }
  // These return the size of the file and the end of the last event read. The size of a pipe is
  // unknown: the largest integer.
  std::int64_t size_bytes() const { return size_; }
  std::int64_t position_bytes() const { return position_; }
  // Throws EventLogError: the last event read is damaged.
  [[noreturn]] void refuse_last(const std::string& why) const { damaged_at(before_, why); }

 private:
  [[noreturn]] void damaged(const std::string& what) const { damaged_at(position_, what); }
  [[noreturn]] void damaged_at(std::int64_t position, const std::string& what) const;

  std::string path_;
  FileHandle file_;
  std::int64_t size_ = 0, position_ = 0, before_ = 0;  // before_: where the last event begins
  bool truncated_ = false;
};

// EventLogReader reads a log event by event: a file, or the pieces of a journal as one log.
class EventLogReader {
 public:
  // `path`: a log, a piece of a journal, with which its later pieces are read, or a folder with the
  // pieces of one journal (journal_pieces.h). Throws EventLogError if it cannot be opened or is
  // empty.
  explicit EventLogReader(const std::string& path);

  // Reads the next event, as EventFileReader does. The pieces of a journal give each event once; an
  // event whose number does not follow in its file is damage.
  bool next(LogEvent* event);

  // Whether the last file ends with an event that is cut short.
  bool truncated() const { return file_->truncated(); }
  // Returns the number of events of a journal that are missing before the last one read, because
  // pieces are: they were deleted, or are damaged at their ends.
  std::int64_t missing() const { return missing_; }
  // The first of the pieces; nullopt: the log has none.
  const std::optional<PieceInfo>& first_piece() const { return first_piece_; }
  // The piece of the last event read, and at the beginning the first one; nullopt: the log has
  // none.
  const std::optional<PieceInfo>& piece() const { return piece_; }
  // Of all files.
  std::int64_t size_bytes() const { return size_; }
  std::int64_t position_bytes() const { return passed_ + file_->position_bytes(); }

 private:
  // Numbers in the open file.
  struct Numbers {
    std::int64_t next = 0, copied = -1;  // copied: allowed beside `next`
    bool began = false;                  // its mark PIECE was read
  };
  bool open_next_file();
  void check_number(const LogEvent& event);

  std::vector<std::string> paths_;
  std::optional<PieceInfo> first_piece_, piece_;
  std::size_t opened_ = 0;  // of paths_
  std::unique_ptr<EventFileReader> file_;
  Numbers numbers_;
  std::int64_t size_ = 0, passed_ = 0;  // bytes of all files, of those before the open one
  std::int64_t next_number_ = 0, missing_ = 0;
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
