#include "drivers/xsens/xsens_framer.h"

#include "drivers/binary/big_endian.h"
#include "drivers/xsens/data_groups.h"

namespace leonav {
namespace {

constexpr std::uint8_t kBus = 0xFF;         // a sensor by itself
constexpr std::uint8_t kLongLength = 0xFF;  // the length follows in two bytes

std::span<const std::uint8_t> payload_of(std::span<const std::uint8_t> message) {
  const std::size_t header =
      message[3] == kLongLength ? XsensFraming::kLongHeader : XsensFraming::kShortHeader;
  return message.subspan(header, message.size() - header - XsensFraming::kChecksum);
}

}  // namespace

XsensFraming::Checksum XsensFraming::continued(Checksum before, std::uint8_t byte) {
  return static_cast<Checksum>(before + byte);
}

StartClaim XsensFraming::claim_of(std::span<const std::uint8_t> bytes) {
  if (bytes.size() >= 2 && bytes[1] != kBus) return {StartClaim::kImpossible};
  if (bytes.size() < kShortHeader) return {StartClaim::kIncomplete};
  if (bytes[3] != kLongLength) return {StartClaim::kMessage, kShortHeader + bytes[3] + kChecksum};
  if (bytes[2] != kMtData2) return {StartClaim::kImpossible};
  if (bytes.size() < kLongHeader) return {StartClaim::kIncomplete};
  const std::size_t payload = read_big_u2(bytes.data() + 4);
  if (payload <= kMaxShort || payload > kMaxPayload) return {StartClaim::kImpossible};
  return {StartClaim::kMessage, kLongHeader + payload + kChecksum};
}

// All bytes but the preamble, with the checksum, add up to zero modulo 256.
bool XsensFraming::checksum_is_good(std::span<const std::uint8_t> message, const Checksum* before) {
  return before[1] == before[message.size()];
}

MessageStarts::Reason XsensFraming::fault_of(std::span<const std::uint8_t> message, bool is_first) {
  if (message[2] == kMtData2) {
    return DataGroups::fill(payload_of(message)) ? MessageStarts::kWaiting
                                                 : MessageStarts::kBadContent;
  }
  return is_first ? MessageStarts::kWaiting : MessageStarts::kBadChecksum;
}

template class MessageFramer<XsensFraming>;

bool XsensFramer::next(XsensMessage* message) {
  const Bytes bytes = take_message();
  if (bytes.empty()) return false;
  *message = {bytes[2], payload_of(bytes)};
  return true;
}

XsensFramerCounters XsensFramer::counters() const {
  const MessageFramerCounts& c = counts();
  return {c.messages, c.bytes_skipped, c.bad_checksums, c.impossible, c.bad_content, c.incomplete};
}

}  // namespace leonav
