#include "drivers/rinex/line_source.h"

#include <array>
#include <fstream>

namespace leonav {
namespace {

// The program that unpacks a file with these first bytes; nullptr if they are not a packer's.
const char* unpacker_for(const std::array<unsigned char, 3>& head) {
  if (head[0] == 0x1f && head[1] == 0x8b) return "gunzip";
  if (head[0] == 0x1f && (head[1] == 0x9d || head[1] == 0xa0)) return "uncompress";
  if (head[0] == 'B' && head[1] == 'Z' && head[2] == 'h') return "bunzip2";
  if (head[0] == 'P' && head[1] == 'K') return "unzip";
  if (head[0] == 0xfd && head[1] == '7' && head[2] == 'z') return "unxz";
  return nullptr;
}

}  // namespace

LineSource::LineSource(const std::string& path) : reader_(path) {
  std::array<unsigned char, 3> head{};
  std::ifstream stream(path, std::ios::binary);
  stream.read(reinterpret_cast<char*>(head.data()), head.size());
  if (const char* unpacker = unpacker_for(head)) {
    throw FileError(path, 0, std::string("the file is compressed; unpack it with ") + unpacker);
  }
}

bool LineSource::next(std::string_view& line) {
  if (!stepped_back_ && !reader_.next(line_)) {
    line_ = {};
    return false;
  }
  stepped_back_ = false;
  line = line_;
  return true;
}

}  // namespace leonav
