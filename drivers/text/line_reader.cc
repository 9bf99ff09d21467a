#include "drivers/text/line_reader.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace leonav {
namespace {

// Returns the program that unpacks a file with these first bytes, or nullptr if no packer is known.
const char* unpacker_for(const std::array<unsigned char, 3>& head) {
  if (head[0] == 0x1f && head[1] == 0x8b) return "gunzip";
  if (head[0] == 0x1f && (head[1] == 0x9d || head[1] == 0xa0)) return "uncompress";
  if (head[0] == 'B' && head[1] == 'Z' && head[2] == 'h') return "bunzip2";
  if (head[0] == 'P' && head[1] == 'K') return "unzip";
  if (head[0] == 0xfd && head[1] == '7' && head[2] == 'z') return "unxz";
  return nullptr;
}

}  // namespace

LineReader::LineReader(const std::string& path) : path_(path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw FileError(path, 0, "is a directory; give the file inside it");
  }
  errno = 0;
  stream_.open(path, std::ios::binary);
  if (!stream_) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "unknown reason";
    throw FileError(path, 0,
                    "cannot be opened (" + reason + "); check the path and that it is readable");
  }
  refuse_compressed();
}

void LineReader::refuse_compressed() {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path_, ignored)) return;  // a pipe cannot be rewound
  std::array<unsigned char, 3> head{};
  stream_.read(reinterpret_cast<char*>(head.data()), head.size());
  if (const char* unpacker = unpacker_for(head)) {
    throw FileError(path_, 0, std::string("the file is compressed; unpack it with ") + unpacker);
  }
  stream_.clear();  // the end of a file of less than three bytes
  stream_.seekg(0);
}

bool LineReader::next(std::string_view& line) {
  if (stepped_back_) {
    stepped_back_ = false;
    line = line_;
    return true;
  }
  line_.clear();
  std::streambuf* const buffer = stream_.rdbuf();
  bool any = false;
  for (;;) {
    const int c = buffer->sbumpc();
    if (c == std::char_traits<char>::eof()) break;
    any = true;
    if (c == '\n') break;
    if (line_.size() >= kMaxLineLength) {
      ++line_number_;
      fail("line is longer than " + std::to_string(kMaxLineLength) +
           " characters; this is not a text file of the expected format");
    }
    line_.push_back(static_cast<char>(c));
  }
  if (!any) return false;
  ++line_number_;
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  line = line_;
  return true;
}

void LineReader::fail(const std::string& message) const {
  throw FileError(path_, line_number_, message);
}

}  // namespace leonav
