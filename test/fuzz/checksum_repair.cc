#include "test/fuzz/checksum_repair.h"

#include <algorithm>
#include <boost/crc.hpp>
#include <span>
#include <string_view>

#include "drivers/binary/correction_page.h"
#include "drivers/binary/crc16.h"
#include "drivers/binary/crc24q.h"
#include "drivers/lcm/event_header.h"
#include "drivers/oem7/crc32.h"
#include "drivers/vectornav/field_layout.h"

namespace leonav::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Span = std::span<std::uint8_t>;

std::uint8_t low_byte(std::size_t value) { return static_cast<std::uint8_t>(value & 0xFF); }

std::size_t half_at(Span bytes, std::size_t at) { return bytes[at] | bytes[at + 1] << 8; }

// `repair(message)` gets all bytes from a place on; it returns the length of the message that it
// has repaired there, or 0.
template <typename Repair>
void repair_each(Bytes* bytes, Repair repair) {
  const Span all(*bytes);
  for (std::size_t i = 0; i < all.size();) i += std::max<std::size_t>(repair(all.subspan(i)), 1);
}

std::size_t repaired_oem7(Span message) {
  if (message.size() < 16 || message[0] != 0xAA || message[1] != 0x44) return 0;
  const bool is_long = message[2] == 0x12;
  if (!is_long && message[2] != 0x13) return 0;
  const std::size_t size = is_long ? message[3] + half_at(message, 8) : 12U + message[3];
  if (size + 4 > message.size()) return 0;
  std::uint32_t crc = 0;
  for (const std::uint8_t byte : message.first(size)) crc = crc32_next(crc, byte);
  for (std::size_t i = 0; i < 4; ++i) message[size + i] = low_byte(crc >> (8 * i));
  return size + 4;
}

std::size_t repaired_xsens(Span message) {
  if (message.size() < 5 || message[0] != 0xFA || message[1] != 0xFF) return 0;
  const bool is_long = message[3] == 0xFF;
  const std::size_t header = is_long ? 6 : 4;
  if (message.size() < header + 1) return 0;
  const std::size_t size = header + (is_long ? message[4] << 8 | message[5] : message[3]);
  if (size + 1 > message.size()) return 0;
  std::size_t sum = 0;
  for (const std::uint8_t byte : message.subspan(1, size - 1)) sum += byte;
  message[size] = low_byte(256 - sum % 256);
  return size + 1;
}

int digit_of(std::uint8_t letter) {
  constexpr std::string_view kDigits = "0123456789ABCDEFabcdef";
  const std::size_t found = kDigits.find(static_cast<char>(letter));
  if (found == std::string_view::npos) return -1;
  return static_cast<int>(found > 15 ? found - 6 : found);
}

std::uint8_t letter_of(std::size_t digit) {
  return static_cast<std::uint8_t>("0123456789ABCDEF"[digit & 15]);
}

// Repairs the page that a line ends in, as two hexadecimal digits an octet.
void repair_page_line(Span line) {
  constexpr std::size_t kOctets = CorrectionPage::kBits / 8 + 1;
  std::size_t first = line.size();
  while (first > 0 && digit_of(line[first - 1]) >= 0) --first;
  const Span digits = line.subspan(first);
  if (digits.size() < 2 * kOctets) return;
  std::array<std::uint8_t, kOctets> page{};
  for (std::size_t i = 0; i < kOctets; ++i) {
    page[i] = low_byte(
        static_cast<std::size_t>(digit_of(digits[2 * i]) << 4 | digit_of(digits[2 * i + 1])));
  }
  const std::uint32_t crc = crc24q(BitReader(page), CorrectionPage::kContentBits);
  for (int bit = 0; bit < 24; ++bit) {
    const auto at = static_cast<std::size_t>(CorrectionPage::kContentBits + bit);
    const auto mask = static_cast<std::uint8_t>(0x80U >> at % 8);
    const bool is_set = (crc >> (23 - bit) & 1U) != 0;
    page[at / 8] = static_cast<std::uint8_t>(is_set ? page[at / 8] | mask : page[at / 8] & ~mask);
  }
  for (std::size_t i = 0; i < kOctets; ++i) {
    digits[2 * i] = letter_of(page[i] >> 4U);
    digits[2 * i + 1] = letter_of(page[i]);
  }
}

template <typename Repair>
void repair_each_line(Bytes* bytes, Repair repair) {
  const Span all(*bytes);
  for (auto begin = all.begin(); begin != all.end();) {
    const auto end = std::find(begin, all.end(), '\n');
    Span line(begin, end);
    if (!line.empty() && line.back() == '\r') line = line.first(line.size() - 1);
    repair(line);
    begin = end == all.end() ? end : end + 1;
  }
}

}  // namespace

void repair_ubx(Bytes* bytes) {
  repair_each(bytes, [](Span message) -> std::size_t {
    if (message.size() < 8 || message[0] != 0xB5 || message[1] != 0x62) return 0;
    const std::size_t size = 6 + half_at(message, 4);
    if (size + 2 > message.size()) return 0;
    std::size_t a = 0, b = 0;
    for (const std::uint8_t byte : message.subspan(2, size - 2)) b += a += byte;
    message[size] = low_byte(a);
    message[size + 1] = low_byte(b);
    return size + 2;
  });
}

void repair_rtcm3(Bytes* bytes) {
  repair_each(bytes, [](Span message) -> std::size_t {
    if (message.size() < 6 || message[0] != 0xD3) return 0;
    const std::size_t size = 3 + ((message[1] & 3U) << 8 | message[2]);
    if (size + 3 > message.size()) return 0;
    message[1] &= 3U;
    std::uint32_t crc = 0;
    for (const std::uint8_t byte : message.first(size)) crc = crc24q_next(crc, byte);
    for (std::size_t i = 0; i < 3; ++i) message[size + i] = low_byte(crc >> (16 - 8 * i));
    return size + 3;
  });
}

void repair_sbf(Bytes* bytes) {
  repair_each(bytes, [](Span block) -> std::size_t {
    if (block.size() < 8 || block[0] != '$' || block[1] != '@') return 0;
    const std::size_t size = half_at(block, 6);
    if (size < 8 || size % 4 != 0 || size > block.size()) return 0;
    const std::uint16_t crc = crc16(block.subspan(4, size - 4));
    block[2] = low_byte(crc);
    block[3] = low_byte(crc >> 8U);
    return size;
  });
}

void repair_oem7(Bytes* bytes) { repair_each(bytes, repaired_oem7); }

void repair_vectornav(Bytes* bytes) {
  repair_each(bytes, [](Span message) -> std::size_t {
    VectornavExtent extent;
    if (message[0] != 0xFA ||
        read_vectornav_header(message, &extent) != VectornavHeader::kComplete ||
        extent.total_bytes() > message.size()) {
      return 0;
    }
    const std::size_t size = extent.total_bytes() - 2;
    const std::uint16_t crc = crc16(message.subspan(1, size - 1));
    message[size] = low_byte(crc >> 8U);
    message[size + 1] = low_byte(crc);
    return size + 2;
  });
}

void repair_xsens(Bytes* bytes) { repair_each(bytes, repaired_xsens); }

void repair_nmea_lines(Bytes* bytes) {
  repair_each_line(bytes, [](Span line) {
    const auto star = std::find(line.begin(), line.end(), '*');
    if (line.empty() || line[0] != '$' || line.end() - star != 3) return;
    std::uint8_t sum = 0;
    for (auto at = line.begin() + 1; at != star; ++at) sum ^= *at;
    star[1] = letter_of(sum >> 4U);
    star[2] = letter_of(sum);
  });
}

void repair_page_lines(Bytes* bytes) { repair_each_line(bytes, repair_page_line); }

void repair_products(Bytes* bytes) {
  constexpr std::size_t kSum = 4, kEvent = kEventHeaderBytes + 5 + kSum;
  if (bytes->size() < kEvent) return;
  boost::crc_32_type crc;
  crc.process_bytes(bytes->data(), bytes->size() - kEvent);
  const std::uint32_t sum = crc.checksum();
  for (std::size_t i = 0; i < kSum; ++i) {
    (*bytes)[bytes->size() - kSum + i] = low_byte(sum >> (24 - 8 * i));
  }
}

}  // namespace leonav::test
