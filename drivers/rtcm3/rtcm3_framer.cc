#include "drivers/rtcm3/rtcm3_framer.h"

#include <algorithm>

#include "drivers/binary/crc24q.h"

namespace leonav {
namespace {

constexpr std::uint8_t kPreamble = 0xD3;
constexpr std::uint8_t kReservedBits = 0xFC;
constexpr std::size_t kMinMessage = 2;  // bytes that hold a message number

constexpr std::size_t kPowers = 1030;

// Entry n is what n bytes of zeros make of the checksum 1: x^(8n) modulo the generator.
constexpr std::array<std::uint32_t, kPowers> byte_powers() {
  std::array<std::uint32_t, kPowers> powers{};
  powers[0] = 1;
  for (std::size_t n = 1; n < kPowers; ++n) powers[n] = crc24q_next(powers[n - 1], 0);
  return powers;
}
constexpr std::array<std::uint32_t, kPowers> kBytePowers = byte_powers();

}  // namespace

std::size_t Rtcm3Framer::append(std::span<const std::uint8_t> bytes) {
  if (begin_ > 0 && end_ + bytes.size() > kCapacity) {
    const auto first = static_cast<std::ptrdiff_t>(begin_);
    const auto last = static_cast<std::ptrdiff_t>(end_);
    std::copy(buffer_.begin() + first, buffer_.begin() + last, buffer_.begin());
    std::copy(crc_before_.begin() + first, crc_before_.begin() + last + 1, crc_before_.begin());
    end_ -= begin_;
    begin_ = 0;
  }
  const std::size_t count = std::min(bytes.size(), kCapacity - end_);
  for (std::size_t i = 0; i < count; ++i) {
    buffer_[end_] = bytes[i];
    crc_before_[end_ + 1] = crc24q_next(crc_before_[end_], bytes[i]);
    ++end_;
  }
  return count;
}

// The checksum of a piece of the stream follows from those before its first byte and behind its
// last, because a checksum is linear: the first one, moved on by the length of the piece, is what
// the bytes before contribute to the second. Over a frame and its own checksum it is zero.
bool Rtcm3Framer::checksum_is_good(std::size_t first, std::size_t size) const {
  static_assert(kMaxFrame < kPowers);
  return crc24q_product(crc_before_[first], kBytePowers[size]) == crc_before_[first + size];
}

bool Rtcm3Framer::next(Rtcm3Frame* frame) {
  while (end_ - begin_ >= kHeader) {
    if (buffer_[begin_] != kPreamble || (buffer_[begin_ + 1] & kReservedBits) != 0) {
      skip_to_preamble();
      continue;
    }
    const std::size_t length =
        (static_cast<std::size_t>(buffer_[begin_ + 1]) << 8) | buffer_[begin_ + 2];
    const std::size_t size = kHeader + length + kChecksum;
    if (end_ - begin_ < size) {
      if (!finished_) return false;
      ++counters_.incomplete;
      skip(1);
      continue;
    }
    if (!checksum_is_good(begin_, size)) {
      ++counters_.bad_checksums;
      skip(1);
      continue;
    }
    frame->message = std::span(buffer_).subspan(begin_ + kHeader, length);
    begin_ += size;
    ++counters_.frames;
    if (length < kMinMessage) {  // an empty frame is filling
      ++counters_.too_short;
      continue;
    }
    frame->type = static_cast<std::uint16_t>((frame->message[0] << 4) | (frame->message[1] >> 4));
    return true;
  }
  if (finished_) skip(end_ - begin_);
  return false;
}

void Rtcm3Framer::skip(std::size_t count) {
  begin_ += count;
  counters_.bytes_skipped += count;
}

void Rtcm3Framer::skip_to_preamble() {
  const auto from = buffer_.begin() + static_cast<std::ptrdiff_t>(begin_) + 1;
  const auto found =
      std::find(from, buffer_.begin() + static_cast<std::ptrdiff_t>(end_), kPreamble);
  skip(static_cast<std::size_t>(found - from) + 1);
}

}  // namespace leonav
