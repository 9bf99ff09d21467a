#include "drivers/sbf/sbf_framer.h"

#include "drivers/binary/crc16.h"
#include "drivers/binary/crc_of_piece.h"
#include "drivers/binary/little_endian.h"

namespace leonav {
namespace {

constexpr std::uint8_t kSync2 = '@';
constexpr std::size_t kCovered = 4;   // the checksum begins with the number
constexpr std::size_t kStamped = 14;  // header; time stamp, 4 + 2
constexpr std::uint16_t kNumberMask = 0x1FFF;
constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
constexpr int kMaxWeek = 8191;  // the year 2137

using Crc16OfPiece = CrcOfPiece<crc16_next, crc16_product, std::uint16_t{1}>;

// Values that the receiver does not know are 4294967295 ms and 65535 weeks.
GpsTime time_of(int week, std::uint32_t milliseconds) {
  if (week < 1 || week > kMaxWeek || milliseconds >= kSecondsPerWeek * 1000) return {};
  return GpsTime::from_nanoseconds(week * kNanosecondsPerWeek +
                                   milliseconds * kNanosecondsPerMillisecond);
}

}  // namespace

SbfFraming::Checksum SbfFraming::continued(Checksum before, std::uint8_t byte) {
  return crc16_next(before, byte);
}

StartClaim SbfFraming::claim_of(std::span<const std::uint8_t> bytes) {
  if (bytes[1] != kSync2) return {};
  const std::size_t size = read_u2(bytes.data() + 6);
  if (size < kStamped || size > kMaxSize || size % 4 != 0) return {StartClaim::kImpossible};
  return {StartClaim::kMessage, size};
}

bool SbfFraming::checksum_is_good(std::span<const std::uint8_t> block, const Checksum* before) {
  const std::size_t covered = block.size() - kCovered;
  return Crc16OfPiece::get(before[kCovered], before[block.size()], covered) ==
         read_u2(block.data() + 2);
}

template class MessageFramer<SbfFraming>;

bool SbfFramer::next(SbfBlock* block) {
  const Bytes bytes = take_message();
  if (bytes.empty()) return false;
  const std::uint8_t* p = bytes.data();
  block->number = read_u2(p + 4) & kNumberMask;
  block->time = time_of(read_u2(p + 12), read_u4(p + 8));
  block->payload = bytes.subspan(kStamped);
  return true;
}

SbfFramerCounters SbfFramer::counters() const {
  const MessageFramerCounts& c = counts();
  return {c.messages,      c.bytes_skipped, framing().text_bytes,
          c.bad_checksums, c.impossible,    c.incomplete};
}

}  // namespace leonav
