#include "drivers/vectornav/field_layout.h"

#include <array>

#include "drivers/binary/little_endian.h"

namespace leonav {
namespace {

using Lengths = std::array<std::uint8_t, kVectornavFields>;

// A GNSS group's last two fields, satellites and raw measurements, have no fixed length.
constexpr Lengths kGnssLengths = {8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, 0, 0};

constexpr std::array<Lengths, kVectornavGroups> kLengths = {{
    {8, 8, 8, 12, 16, 12, 24, 12, 12, 24, 20, 28, 2, 4, 8, 0},     // common
    {8, 8, 8, 2, 8, 8, 8, 4, 4, 1, 0, 0, 0, 0, 0, 0},              // time
    {2, 12, 12, 12, 4, 4, 16, 12, 12, 12, 12, 2, 0, 0, 0, 0},      // IMU
    kGnssLengths,                                                  // GNSS 1
    {2, 12, 16, 36, 12, 12, 12, 12, 12, 12, 28, 24, 12, 0, 0, 0},  // attitude
    {2, 24, 24, 12, 12, 12, 12, 12, 12, 4, 4, 68, 64, 0, 0, 0},    // INS
    kGnssLengths,                                                  // GNSS 2
}};

constexpr std::size_t longest_message() {
  std::size_t sum = 2 + 2 * kVectornavGroups + 2;
  for (const Lengths& lengths : kLengths) {
    for (const std::uint8_t length : lengths) sum += length;
  }
  return sum;
}
static_assert(longest_message() <= kMaxVectornavMessage);

}  // namespace

std::size_t vectornav_field_bytes(VectornavGroup group, std::size_t field) {
  return kLengths[static_cast<std::size_t>(group)][field];
}

VectornavHeader read_vectornav_header(std::span<const std::uint8_t> bytes,
                                      VectornavExtent* extent) {
  if (bytes.size() < 2) return VectornavHeader::kIncomplete;
  const std::uint8_t groups = bytes[1];
  // The highest bit announces further groups, which newer firmware has; no group at all is no
  // message.
  if (groups == 0 || (groups & 0x80) != 0) return VectornavHeader::kUnknownField;
  *extent = {2, 0};
  for (std::size_t group = 0; group < kVectornavGroups; ++group) {
    if ((groups >> group & 1) == 0) continue;
    if (bytes.size() < extent->header_bytes + 2) return VectornavHeader::kIncomplete;
    const std::uint16_t mask = read_u2(bytes.data() + extent->header_bytes);
    extent->header_bytes += 2;
    for (std::size_t field = 0; field < kVectornavFields; ++field) {
      if ((mask >> field & 1) == 0) continue;
      if (kLengths[group][field] == 0) return VectornavHeader::kUnknownField;
      extent->payload_bytes += kLengths[group][field];
    }
  }
  return VectornavHeader::kComplete;
}

}  // namespace leonav
