// This unit writes and reads recordings: every byte of a stream with the time at which it arrived.
//
// A recording begins with the line "leonav recording 1". Blocks follow, each of them the time of
// arrival (8 bytes, nanoseconds since 1970), a length (4 bytes) and so many bytes of the stream;
// numbers are little endian.
#pragma once
#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace leonav {

// Appends blocks to a new file. An error ends the recording, and nothing else.
class RecordingWriter {
 public:
  // Never overwrites: a file that exists is kept, and PATH.1, PATH.2, ... is written. Throws
  // FileError where none can be created.
  explicit RecordingWriter(const std::string& path);

  // Returns false once writing has failed; error() then says why.
  bool write(std::int64_t arrival_ns, std::span<const std::uint8_t> bytes);
  bool flush();
  const std::string& path() const { return path_; }
  const std::string& error() const { return error_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  bool fail();

  std::string path_, error_;
  std::unique_ptr<std::FILE, Close> file_;
};

// Reads a file in blocks: a recording by its own, any other file in pieces without a time.
class BlockReader {
 public:
  struct Block {
    std::int64_t arrival_ns = 0;  // 0: not a recording
    std::vector<std::uint8_t> bytes;
  };

  // Throws FileError where the file cannot be opened.
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

}  // namespace leonav
