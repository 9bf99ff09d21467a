#include "daemon/link/datagram_filter.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace leonav {
namespace {

// "LCM UDP Multicast Protocol Description" (LCM documentation), numbers are big endian, as the
// kernel loads them. A message in one datagram: magic word (4 bytes), number of the message (4),
// channel with a zero byte, data. A fragment: magic word (4), number of the message (4), size of
// the data (4), offset of the fragment (4), its number (2), how many there are (2); the first one,
// number 0, then has the channel with a zero byte. The filter sees the UDP header (8) in front.
constexpr std::uint32_t kShortMagic = 0x4C433032, kFragmentMagic = 0x4C433033;  // "LC02", "LC03"
constexpr std::uint32_t kMagicAt = 8, kSizeAt = kMagicAt + 8, kNumberAt = kMagicAt + 16;
constexpr std::uint32_t kChannelAt = kMagicAt + 8, kChannelOfFragmentAt = kMagicAt + 20;

constexpr std::uint32_t kWholeDatagram = 0xFFFFFFFF, kNothing = 0;
constexpr std::uint32_t kSize = 0;  // the filter's memory: of the data

// Some bytes of a text that one instruction loads, as a number.
struct Piece {
  std::uint32_t at, number;
  std::uint16_t width;  // BPF_W, BPF_H or BPF_B
};

std::vector<Piece> pieces(std::string_view text, std::size_t begin) {
  std::vector<Piece> all;
  while (begin < text.size()) {
    const std::size_t left = text.size() - begin, bytes = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    Piece piece{static_cast<std::uint32_t>(begin), 0,
                static_cast<std::uint16_t>(bytes == 4   ? BPF_W
                                           : bytes == 2 ? BPF_H
                                                        : BPF_B)};
    for (std::size_t i = 0; i < bytes; ++i)
      piece.number = piece.number << 8 | static_cast<std::uint8_t>(text[begin + i]);
    all.push_back(piece);
    begin += bytes;
  }
  return all;
}

// How many characters all have alike at their beginning.
std::size_t common_length(const std::vector<ReceivedChannel>& channels) {
  const std::string& first = channels.front().name;
  std::size_t length = first.size();
  for (const auto& [name, most_bytes] : channels) {
    const auto parted = std::mismatch(name.begin(), name.end(), first.begin(), first.end()).first;
    length = std::min(length, static_cast<std::size_t>(parted - name.begin()));
  }
  return length;
}

// Loads the piece of the channel, which begins at the index register, and goes on `if_equal` or
// `otherwise` instructions behind the next one.
void compare(const Piece& piece, std::uint8_t if_equal, std::uint8_t otherwise,
             std::vector<sock_filter>* program) {
  program->push_back(
      BPF_STMT(static_cast<std::uint16_t>(BPF_LD | piece.width | BPF_IND), piece.at));
  program->push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, piece.number, if_equal, otherwise));
}

}  // namespace

std::vector<sock_filter> datagram_filter(const std::vector<ReceivedChannel>& channels) {
  std::uint32_t most_bytes = 0;
  for (const ReceivedChannel& channel : channels)
    most_bytes = std::max(most_bytes, channel.most_bytes);
  // A datagram that is too short for what is loaded is dropped.
  std::vector<sock_filter> program = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kMagicAt),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kShortMagic, 11, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kFragmentMagic, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, kNothing),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kSizeAt),
      BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, most_bytes, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, kNothing),
      BPF_STMT(BPF_ST, kSize),
      BPF_STMT(BPF_LD | BPF_H | BPF_ABS, kNumberAt),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 0, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, kWholeDatagram),
      BPF_STMT(BPF_LDX | BPF_W | BPF_IMM, kChannelOfFragmentAt),
      BPF_STMT(BPF_JMP | BPF_JA, 4),
      BPF_STMT(BPF_LDX | BPF_W | BPF_IMM, kChannelAt),
      BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0),
      BPF_STMT(BPF_ALU | BPF_SUB | BPF_X, 0),
      BPF_STMT(BPF_ST, kSize),
  };
  const std::size_t common = common_length(channels);
  for (const Piece& piece : pieces(std::string_view(channels.front().name).substr(0, common), 0)) {
    compare(piece, 1, 0, &program);
    program.push_back(BPF_STMT(BPF_RET | BPF_K, kNothing));
  }
  for (const ReceivedChannel& channel : channels) {
    // With the zero byte.
    const std::vector<Piece> rest = pieces({channel.name.c_str(), channel.name.size() + 1}, common);
    for (std::size_t i = 0; i < rest.size(); ++i) {
      // The pieces behind it, two instructions each, and the four that judge the size.
      const auto to_next_channel = static_cast<std::uint8_t>(2 * (rest.size() - 1 - i) + 4);
      compare(rest[i], 0, to_next_channel, &program);
    }
    program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_MEM, kSize));
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, channel.most_bytes, 1, 0));
    program.push_back(BPF_STMT(BPF_RET | BPF_K, kWholeDatagram));
    program.push_back(BPF_STMT(BPF_RET | BPF_K, kNothing));
  }
  program.push_back(BPF_STMT(BPF_RET | BPF_K, kNothing));
  return program;
}

}  // namespace leonav
