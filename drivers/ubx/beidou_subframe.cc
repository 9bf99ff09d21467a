#include "drivers/ubx/beidou_subframe.h"

#include "core/time/gps_time.h"
#include "drivers/ubx/bit_field.h"

namespace leonav {
namespace {

constexpr std::uint32_t kPreamble = 0b111'0001'0010;

// Bits `first`, `first` - 2, ... of `word`, `count` of them: one of the two interleaved codes.
constexpr std::uint32_t every_second_bit(std::uint32_t word, int first, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value = (value << 1) | ((word >> (first - 2 * i)) & 1u);
  return value;
}

// Word one: 15 bits without check, then one codeword. The others: two codewords, interleaved bit
// by bit (figure 5-5).
bool checks_are_good(std::span<const std::uint32_t, kBeidouWords> words) {
  if (beidou_bch((words[0] >> 4) & 0x7FF) != (words[0] & 0xF)) return false;
  for (const std::uint32_t word : words.subspan(1)) {
    for (const int lane : {29, 28}) {
      if (beidou_bch(every_second_bit(word, lane, 11)) != every_second_bit(word, lane - 22, 4)) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

std::optional<BeidouSubframe> read_beidou_subframe(
    std::span<const std::uint32_t, kBeidouWords> words) {
  if (((words[0] >> 19) & 0x7FF) != kPreamble || !checks_are_good(words)) return std::nullopt;
  BitWriter<28> writer;
  writer.put(words[0] >> 4, 26);
  for (const std::uint32_t word : words.subspan(1)) writer.put(word >> 8, 22);

  BeidouSubframe subframe;
  subframe.bits = writer.bytes();
  BitReader header(subframe.bits);
  subframe.number = header.skip(11 + 4).take(3);
  subframe.sow_s = header.take(20);
  if (subframe.number < 1 || subframe.number > 5 || subframe.sow_s >= kSecondsPerWeek) {
    return std::nullopt;
  }
  return subframe;
}

}  // namespace leonav
