#include "drivers/ubx/ubx_framer.h"

#include "drivers/binary/little_endian.h"

namespace leonav {
namespace {

constexpr std::uint8_t kSync2 = 0x62;
constexpr std::size_t kCovered = 2;  // the checksum begins with the class
constexpr std::size_t kChecksum = 2;

}  // namespace

UbxFraming::Checksum UbxFraming::continued(Checksum before, std::uint8_t byte) {
  const auto sum = static_cast<std::uint8_t>(before.sum + byte);
  return {sum, static_cast<std::uint8_t>(before.sum_of_sums + sum)};
}

StartClaim UbxFraming::claim_of(std::span<const std::uint8_t> bytes) {
  if (bytes[1] != kSync2) return {};
  const std::size_t length = read_u2(bytes.data() + 4);
  if (length > kMaxPayload) return {StartClaim::kImpossible};
  return {StartClaim::kMessage, length + kOverhead};
}

// The 8-bit Fletcher checksum of n bytes follows from running sums: with S and T the sums before
// them and S' and T' those behind, A = S' - S, B = T' - T - n S. A candidate therefore costs the
// same whatever its length field is, and a stream full of false syncs cannot make the search slow.
bool UbxFraming::checksum_is_good(std::span<const std::uint8_t> message, const Checksum* before) {
  const std::size_t end = message.size() - kChecksum;
  const Checksum &first = before[kCovered], &last = before[end];
  const auto n = static_cast<std::uint8_t>(end - kCovered);
  const auto a = static_cast<std::uint8_t>(last.sum - first.sum);
  const auto b = static_cast<std::uint8_t>(last.sum_of_sums - first.sum_of_sums - n * first.sum);
  return a == message[end] && b == message[end + 1];
}

void UbxFraming::skip(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) foreign.take(byte);
}

template class MessageFramer<UbxFraming>;

bool UbxFramer::next(UbxMessage* message) {
  const Bytes bytes = take_message();
  if (bytes.empty()) return false;
  framing().foreign.interrupt();
  *message = {bytes[2], bytes[3],
              bytes.subspan(UbxFraming::kMinHeader, bytes.size() - UbxFraming::kOverhead)};
  return true;
}

UbxFramerCounters UbxFramer::counters() const {
  const MessageFramerCounts& c = counts();
  return {c.messages,      c.bytes_skipped, framing().foreign.counters(),
          c.bad_checksums, c.impossible,    c.incomplete};
}

}  // namespace leonav
