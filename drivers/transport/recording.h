// This unit writes and reads recordings: every byte of a stream with the time at which it arrived.
//
// A recording begins with the line "leonav recording 1". Blocks follow, each of them the time of
// arrival (8 bytes, nanoseconds since 1970), a length (4 bytes) and so many bytes of the stream;
// numbers are little endian. A block without bytes says that a connection has begun, whose first
// bytes the next block has.
#pragma once
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace leonav {

struct RecordingLimits {
  std::uint64_t file_bytes = 0;          // at which a recording ends; 0: none
  std::size_t queued_bytes = 8U << 20U;  // that wait for the disk; what comes then is dropped
};

// Appends blocks to a new file, in a thread of its own: a disk that stalls holds up nobody. An
// error ends the recording, and nothing else. Whoever destroys it does not wait either: what is
// queued goes to the file as long as the process runs.
class RecordingWriter {
 public:
  // Never overwrites: a file that exists is kept, and PATH.1, PATH.2, ... is written. Throws
  // FileError where none can be created.
  explicit RecordingWriter(const std::string& path, const RecordingLimits& limits = {});
  // Writes to a file that is open, and closes it.
  RecordingWriter(std::FILE* file, const std::string& path, const RecordingLimits& limits);
  ~RecordingWriter() { end(); }
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  // A connection has begun: the next block that finds room comes behind one without bytes, which
  // has the same arrival, so that a recording has one order of times whatever the source's clock
  // is.
  void note_opening() { opening_is_due_ = true; }
  // They wait for nothing, and return false once writing has failed; error() then says why.
  bool write(std::int64_t arrival_ns, std::span<const std::uint8_t> bytes);
  bool flush();
  // Nothing more will be written: what is queued goes to the file, which is then closed.
  void end();
  // The same, and waits for it. A disk that stalls is given up kCloseTimeout after end().
  bool close();

  const std::string& path() const { return path_; }
  std::string error() const;
  // Bytes of the stream that were left out because the disk was too slow.
  std::uint64_t dropped_bytes() const { return dropped_bytes_; }
  // Nine tenths of its limit are used up.
  bool is_near_limit() const {
    return limits_.file_bytes > 0 && accepted_bytes_ > limits_.file_bytes / 10 * 9;
  }

 private:
  static constexpr std::chrono::seconds kCloseTimeout{3};
  struct State;
  void start(std::FILE* file);

  std::string path_;
  RecordingLimits limits_;
  std::uint64_t accepted_bytes_ = 0, dropped_bytes_ = 0;
  bool opening_is_due_ = false;
  std::shared_ptr<State> state_;  // shared with the thread, which a stalled disk may hold for long
};

// Reads a file in blocks: a recording by its own, any other file in pieces without a time.
class BlockReader {
 public:
  struct Block {
    std::int64_t arrival_ns = 0;      // 0: not a recording
    std::vector<std::uint8_t> bytes;  // none: a connection has begun
  };

  // Throws FileError where the path cannot be opened or is no regular file.
  explicit BlockReader(const std::string& path);

  bool is_recording() const { return is_recording_; }
  // Returns false at the end. Throws FileError where the file cannot be read or is damaged; a last
  // block that is cut short counts as the end.
  bool next(Block* block);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  bool next_recorded(Block* block);

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  bool is_recording_ = false;
};

// Returns the first arrival in a recording; nullopt: the file is none, or has no whole block.
std::optional<std::int64_t> first_arrival_ns(const std::string& path);

}  // namespace leonav
