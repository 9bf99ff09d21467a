#include "drivers/vectornav/vectornav_framer.h"

#include "drivers/binary/crc16.h"
#include "drivers/binary/crc_of_piece.h"

namespace leonav {
namespace {

using Crc16OfPiece = CrcOfPiece<crc16_next, crc16_product, std::uint16_t{1}>;

}  // namespace

VectornavFraming::Checksum VectornavFraming::continued(Checksum before, std::uint8_t byte) {
  return crc16_next(before, byte);
}

// A header is of 4 to 16 bytes.
StartClaim VectornavFraming::claim_of(std::span<const std::uint8_t> bytes) {
  VectornavExtent extent;
  switch (read_vectornav_header(bytes, &extent)) {
    case VectornavHeader::kComplete:
      return {StartClaim::kMessage, extent.total_bytes()};
    case VectornavHeader::kIncomplete:
      return {StartClaim::kIncomplete};
    case VectornavHeader::kUnknownField:
      break;
  }
  return {StartClaim::kImpossible};
}

// The sync byte is not under the checksum; over the rest and the transmitted checksum it is zero.
bool VectornavFraming::checksum_is_good(std::span<const std::uint8_t> message,
                                        const Checksum* before) {
  return Crc16OfPiece::get(before[1], before[message.size()], message.size() - 1) == 0;
}

bool VectornavFraming::is_awaited(std::span<const std::uint8_t> bytes) const {
  return std::any_of(known_headers_.begin(), known_headers_.end(), [&](const Header& header) {
    return header.size > 0 && header.size <= bytes.size() &&
           std::equal(header.bytes.begin(), header.bytes.begin() + header.size, bytes.begin());
  });
}

void VectornavFraming::remember(std::span<const std::uint8_t> header) {
  if (is_awaited(header)) return;
  Header& oldest = known_headers_[oldest_header_];
  oldest_header_ = (oldest_header_ + 1) % known_headers_.size();
  oldest.size = header.size();
  std::copy(header.begin(), header.end(), oldest.bytes.begin());
}

template class MessageFramer<VectornavFraming>;

bool VectornavFramer::next(VectornavMessage* message) {
  const Bytes bytes = take_message();
  if (bytes.empty()) return false;
  message->bytes = bytes;
  read_vectornav_header(bytes, &message->extent);
  framing().remember(bytes.first(message->extent.header_bytes));
  return true;
}

VectornavFramerCounters VectornavFramer::counters() const {
  const MessageFramerCounts& c = counts();
  return {c.messages, c.bytes_skipped, c.bad_checksums, c.impossible, c.incomplete + c.cut_headers};
}

}  // namespace leonav
