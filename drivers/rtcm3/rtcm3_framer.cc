#include "drivers/rtcm3/rtcm3_framer.h"

#include "drivers/binary/crc24q.h"
#include "drivers/binary/crc_of_piece.h"

namespace leonav {
namespace {

constexpr std::uint8_t kReservedBits = 0xFC;
constexpr std::size_t kMinMessage = 2;  // bytes that hold a message number

using Crc24qOfPiece = CrcOfPiece<crc24q_next, crc24q_product, std::uint32_t{1}>;

}  // namespace

Rtcm3Framing::Checksum Rtcm3Framing::continued(Checksum before, std::uint8_t byte) {
  return crc24q_next(before, byte);
}

StartClaim Rtcm3Framing::claim_of(std::span<const std::uint8_t> bytes) {
  if ((bytes[1] & kReservedBits) != 0) return {};
  const std::size_t length = (static_cast<std::size_t>(bytes[1]) << 8) | bytes[2];
  return {StartClaim::kMessage, kMinHeader + length + kChecksum};
}

// Over a frame and its own checksum it is zero.
bool Rtcm3Framing::checksum_is_good(std::span<const std::uint8_t> frame, const Checksum* before) {
  return Crc24qOfPiece::get(before[0], before[frame.size()], frame.size()) == 0;
}

template class MessageFramer<Rtcm3Framing>;

bool Rtcm3Framer::next(Rtcm3Frame* frame) {
  for (Bytes bytes = take_message(); !bytes.empty(); bytes = take_message()) {
    frame->message =
        bytes.subspan(Rtcm3Framing::kMinHeader,
                      bytes.size() - Rtcm3Framing::kMinHeader - Rtcm3Framing::kChecksum);
    if (frame->message.size() >= kMinMessage) {
      frame->type = static_cast<std::uint16_t>((frame->message[0] << 4) | (frame->message[1] >> 4));
      return true;
    }
    ++too_short_;  // one without a message is filling
  }
  return false;
}

Rtcm3FramerCounters Rtcm3Framer::counters() const {
  const MessageFramerCounts& c = counts();
  return {c.messages, c.bytes_skipped, c.bad_checksums, c.incomplete, too_short_};
}

}  // namespace leonav
