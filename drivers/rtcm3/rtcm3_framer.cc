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
  if (begin_ > base_ && index(end_) + bytes.size() > kCapacity) {
    const auto first = static_cast<std::ptrdiff_t>(index(begin_));
    const auto last = static_cast<std::ptrdiff_t>(index(end_));
    std::copy(buffer_.begin() + first, buffer_.begin() + last, buffer_.begin());
    std::copy(crc_before_.begin() + first, crc_before_.begin() + last + 1, crc_before_.begin());
    base_ = begin_;
  }
  const std::size_t count = std::min(bytes.size(), kCapacity - index(end_));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = index(end_);
    buffer_[at] = bytes[i];
    crc_before_[at + 1] = crc24q_next(crc_before_[at], bytes[i]);
    ++end_;
  }
  return count;
}

void Rtcm3Framer::find_starts() {
  for (; searched_ + kHeader <= end_; ++searched_) {
    const auto from = buffer_.begin() + static_cast<std::ptrdiff_t>(index(searched_));
    const auto to = buffer_.begin() + static_cast<std::ptrdiff_t>(index(end_) - kHeader + 1);
    searched_ += static_cast<Position>(std::find(from, to, kPreamble) - from);
    if (searched_ + kHeader > end_) return;
    const std::uint8_t* p = buffer_.data() + index(searched_);
    if ((p[1] & kReservedBits) != 0) continue;
    const std::size_t length = (static_cast<std::size_t>(p[1]) << 8) | p[2];
    starts_.add(searched_, searched_ + kHeader + length + kChecksum);
  }
}

// The checksum of a piece of the stream follows from those before its first byte and behind its
// last, because a checksum is linear: the first one, moved on by the length of the piece, is what
// the bytes before contribute to the second. Over a frame and its own checksum it is zero.
bool Rtcm3Framer::checksum_is_good(const MessageStarts::Candidate& candidate) const {
  static_assert(kMaxFrame < kPowers);
  const std::size_t start = index(candidate.start), end = index(candidate.end);
  return crc24q_product(crc_before_[start], kBytePowers[end - start]) == crc_before_[end];
}

bool Rtcm3Framer::next(Rtcm3Frame* frame) {
  find_starts();
  while (const auto candidate = starts_.next_whole(end_)) {
    if (!checksum_is_good(*candidate)) {
      starts_.refuse(*candidate, kBadChecksum);
    } else if (take(*candidate, frame)) {
      return true;
    }
  }
  // Bytes before the first start that still waits belong to no frame.
  skip_to(finished_ ? end_ : starts_.first_waiting().value_or(std::max(searched_, begin_)));
  return false;
}

bool Rtcm3Framer::take(const MessageStarts::Candidate& candidate, Rtcm3Frame* frame) {
  skip_to(candidate.start);
  frame->message = std::span(buffer_).subspan(
      index(candidate.start) + kHeader, candidate.end - candidate.start - kHeader - kChecksum);
  begin_ = candidate.end;
  searched_ = std::max(searched_, begin_);
  starts_.drop_before(begin_);
  ++counters_.frames;
  if (frame->message.size() < kMinMessage) {
    ++counters_.too_short;
    return false;
  }
  frame->type = static_cast<std::uint16_t>((frame->message[0] << 4) | (frame->message[1] >> 4));
  return true;
}

void Rtcm3Framer::skip_to(Position position) {
  const MessageStarts::Counts none = starts_.drop_before(position);
  (finished_ ? counters_.incomplete : counters_.bad_checksums) += none[MessageStarts::kWaiting];
  counters_.bad_checksums += none[kBadChecksum];
  counters_.bytes_skipped += position - begin_;
  begin_ = position;
  searched_ = std::max(searched_, begin_);
}

}  // namespace leonav
