#include "drivers/oem7/oem7_framer.h"

#include "core/base/calendar.h"
#include "drivers/binary/crc_of_piece.h"
#include "drivers/binary/little_endian.h"
#include "drivers/oem7/crc32.h"

namespace leonav {
namespace {

constexpr std::uint8_t kSync2 = 0x44, kLongHeader = 0x12, kShortHeader = 0x13;
constexpr std::size_t kLongSize = 28, kShortSize = Oem7Framing::kMinHeader;
constexpr std::uint8_t kTimeUnknown = 20;  // time status UNKNOWN
constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;

using Crc32OfPiece = CrcOfPiece<crc32_next, crc32_product, std::uint32_t{0x80000000}>;

GpsTime time_of(int week, std::uint32_t milliseconds) {
  if (week < 1 || week > kLastGpsWeek || milliseconds >= kSecondsPerWeek * 1000) return {};
  return GpsTime::from_nanoseconds(week * kNanosecondsPerWeek +
                                   milliseconds * kNanosecondsPerMillisecond);
}

// The long header states its own length, which later firmware may enlarge.
std::size_t header_size(const std::uint8_t* p) { return p[2] == kShortHeader ? kShortSize : p[3]; }

}  // namespace

Oem7Framing::Checksum Oem7Framing::continued(Checksum before, std::uint8_t byte) {
  return crc32_next(before, byte);
}

StartClaim Oem7Framing::claim_of(std::span<const std::uint8_t> bytes) {
  const std::uint8_t* p = bytes.data();
  if (p[1] != kSync2 || (p[2] != kLongHeader && p[2] != kShortHeader)) return {};
  const std::size_t header = header_size(p);
  if (p[2] == kShortHeader) return {StartClaim::kMessage, header + p[3] + kChecksum};
  const std::size_t payload = read_u2(p + 8);
  if (header < kLongSize || header > kMaxHeader || payload > kMaxPayload)
    return {StartClaim::kImpossible};
  return {StartClaim::kMessage, header + payload + kChecksum};
}

// Over a message and its own checksum it is zero.
bool Oem7Framing::checksum_is_good(std::span<const std::uint8_t> message, const Checksum* before) {
  return Crc32OfPiece::get(before[0], before[message.size()], message.size()) == 0;
}

template class MessageFramer<Oem7Framing>;

bool Oem7Framer::next(Oem7Message* message) {
  const Bytes bytes = take_message();
  if (bytes.empty()) return false;
  const std::uint8_t* p = bytes.data();
  const std::size_t header = header_size(p);
  *message = {};
  message->id = read_u2(p + 4);
  message->payload = bytes.subspan(header, bytes.size() - header - Oem7Framing::kChecksum);
  if (p[2] == kShortHeader) {
    message->time = time_of(read_u2(p + 6), read_u4(p + 8));
  } else {
    message->source = p[6] & 0x1F;
    message->is_response = (p[6] & 0x80) != 0;
    if (p[13] > kTimeUnknown) message->time = time_of(read_u2(p + 14), read_u4(p + 16));
  }
  return true;
}

Oem7FramerCounters Oem7Framer::counters() const {
  const MessageFramerCounts& c = counts();
  return {c.messages,      c.bytes_skipped, framing().text_bytes,
          c.bad_checksums, c.impossible,    c.incomplete};
}

}  // namespace leonav
