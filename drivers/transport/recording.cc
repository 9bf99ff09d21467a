#include "drivers/transport/recording.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "drivers/binary/little_endian.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

constexpr std::string_view kFirstLine = "leonav recording 1\n";
constexpr std::size_t kHeaderBytes = 12;
// A block is what one read gave; longer ones are damage.
constexpr std::uint32_t kMaxBlock = 1U << 20;
// Small pieces, so that a file keeps a receiver's pace.
constexpr std::size_t kPiece = 256;

}  // namespace

RecordingWriter::RecordingWriter(const std::string& path) : path_(path) {
  for (int number = 1; std::filesystem::exists(path_) && number < 10'000; ++number) {
    path_ = path + "." + std::to_string(number);
  }
  file_.reset(std::fopen(path_.c_str(), "wbx"));
  if (file_ == nullptr) {
    throw FileError(path_, 0,
                    std::string("cannot be created (") + std::strerror(errno) +
                        "); check the folder of 'record' and its permissions");
  }
  if (std::fwrite(kFirstLine.data(), 1, kFirstLine.size(), file_.get()) != kFirstLine.size()) {
    fail();
  }
}

bool RecordingWriter::write(std::int64_t arrival_ns, std::span<const std::uint8_t> bytes) {
  if (!error_.empty()) return false;
  std::array<std::uint8_t, kHeaderBytes> header;
  for (std::size_t i = 0; i < 8; ++i) {
    header[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(arrival_ns) >> (8 * i));
  }
  for (std::size_t i = 0; i < 4; ++i) {
    header[8 + i] = static_cast<std::uint8_t>(bytes.size() >> (8 * i));
  }
  const bool written =
      std::fwrite(header.data(), 1, header.size(), file_.get()) == header.size() &&
      (bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size());
  return written || fail();
}

bool RecordingWriter::flush() {
  if (!error_.empty()) return false;
  return std::fflush(file_.get()) == 0 || fail();
}

bool RecordingWriter::fail() {
  error_ = path_ + ": cannot be written: " + std::strerror(errno);
  return false;
}

BlockReader::BlockReader(const std::string& path) : path_(path) {
  if (std::filesystem::is_directory(path)) {
    throw FileError(path, 0, "is a directory; name a file of a stream's bytes");
  }
  file_.reset(std::fopen(path.c_str(), "rb"));
  if (file_ == nullptr) {
    throw FileError(path, 0,
                    std::string("cannot be opened (") + std::strerror(errno) +
                        "); check the path and the permissions");
  }
  std::array<char, kFirstLine.size()> first;
  const std::size_t got = std::fread(first.data(), 1, first.size(), file_.get());
  is_recording_ = std::string_view(first.data(), got) == kFirstLine;
  if (!is_recording_) std::rewind(file_.get());
}

bool BlockReader::next(Block* block) {
  if (is_recording_) return next_recorded(block);
  block->arrival_ns = 0;
  block->bytes.resize(kPiece);
  block->bytes.resize(std::fread(block->bytes.data(), 1, kPiece, file_.get()));
  if (std::ferror(file_.get()) != 0) {
    throw FileError(path_, 0, "cannot be read to its end; check the disk");
  }
  return !block->bytes.empty();
}

bool BlockReader::next_recorded(Block* block) {
  std::array<std::uint8_t, kHeaderBytes> header;
  if (std::fread(header.data(), 1, header.size(), file_.get()) != header.size()) {
    if (std::ferror(file_.get()) == 0) return false;
    throw FileError(path_, 0, "cannot be read to its end; check the disk");
  }
  const std::uint32_t length = read_u4(header.data() + 8);
  block->arrival_ns = static_cast<std::int64_t>(read_u8(header.data()));
  if (length > kMaxBlock || block->arrival_ns <= 0) {
    throw FileError(path_, 0,
                    "is damaged before byte " + std::to_string(std::ftell(file_.get())) +
                        ": no block begins there; what came before it has been used");
  }
  block->bytes.resize(length);
  return length == 0 || std::fread(block->bytes.data(), 1, length, file_.get()) == length;
}

}  // namespace leonav
