#include "drivers/navigation_bits/beidou_subframe.h"

#include "core/base/gps_time.h"
#include "drivers/binary/bit_field.h"

namespace leonav {
namespace {

constexpr std::uint32_t kPreamble = 0b111'0001'0010;

// Word one has 15 bits without check, then one codeword. Each other word has two codewords, which
// are sent interleaved (figure 5-5) and which the receiver outputs one after the other: 11 + 11
// information bits, 4 + 4 check bits.
bool checks_are_good(std::span<const std::uint32_t, kBeidouWords> words) {
  if (beidou_bch((words[0] >> 4) & 0x7FF) != (words[0] & 0xF)) return false;
  for (const std::uint32_t word : words.subspan(1)) {
    if (beidou_bch((word >> 19) & 0x7FF) != ((word >> 4) & 0xF)) return false;
    if (beidou_bch((word >> 8) & 0x7FF) != (word & 0xF)) return false;
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
