#include "drivers/has/has_page.h"

#include "drivers/binary/bit_field.h"

namespace leonav {
namespace {

constexpr std::size_t kReservedBits = 14;  // before the header

}  // namespace

bool is_dummy(const CorrectionPage& page) {
  constexpr std::uint32_t kDummyHeader = 0xAF3BC3;
  return BitReader(page.bits).skip(kReservedBits).take(24) == kDummyHeader;
}

HasPage read_has_page(const CorrectionPage& page) {
  BitReader bits(page.bits);
  bits.skip(kReservedBits);
  const auto take = [&bits](int count) { return static_cast<std::uint8_t>(bits.take(count)); };
  HasPage result;
  result.status = take(2);
  bits.skip(2);
  result.message_type = take(2);
  result.message_id = take(5);
  result.message_size = static_cast<std::uint8_t>(take(5) + 1);
  result.encoded.id = take(8);
  for (std::uint8_t& octet : result.encoded.octets) octet = take(8);
  return result;
}

}  // namespace leonav
