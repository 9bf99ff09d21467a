#include "drivers/sbf/sbf_framer.h"

#include <algorithm>

#include "drivers/binary/crc16.h"
#include "drivers/binary/little_endian.h"

namespace leonav {
namespace {

constexpr std::array<std::uint8_t, 2> kSync = {'$', '@'};
// Sync 2, checksum 2, number 2, length 2; then the time stamp, 4 + 2.
constexpr std::size_t kCovered = 4;  // the checksum begins with the number
constexpr std::size_t kHeader = 8, kStamped = 14;
constexpr std::uint16_t kNumberMask = 0x1FFF;
constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
constexpr int kMaxWeek = 8191;  // the year 2137

// Checksums that 1 becomes by n and by 256 n bytes of zeros.
struct Powers {
  std::array<std::uint16_t, 256> ones{}, pages{};
};
constexpr Powers powers_of_byte() {
  Powers powers;
  powers.ones[0] = powers.pages[0] = 1;
  for (std::size_t n = 1; n < powers.ones.size(); ++n) {
    powers.ones[n] = crc16_next(powers.ones[n - 1], 0);
  }
  const std::uint16_t page = crc16_next(powers.ones[255], 0);
  for (std::size_t n = 1; n < powers.pages.size(); ++n) {
    powers.pages[n] = crc16_product(powers.pages[n - 1], page);
  }
  return powers;
}
constexpr Powers kPowers = powers_of_byte();

std::uint16_t moved_on(std::uint16_t crc, std::size_t bytes) {
  return crc16_product(crc16_product(crc, kPowers.ones[bytes % 256]), kPowers.pages[bytes / 256]);
}

// Values that the receiver does not know are 4294967295 ms and 65535 weeks.
GpsTime time_of(int week, std::uint32_t milliseconds) {
  if (week < 1 || week > kMaxWeek || milliseconds >= kSecondsPerWeek * 1000) return {};
  return GpsTime::from_nanoseconds(week * kNanosecondsPerWeek +
                                   milliseconds * kNanosecondsPerMillisecond);
}

bool is_text(std::uint8_t byte) {
  return (byte >= 0x20 && byte < 0x7F) || byte == '\r' || byte == '\n' || byte == '\t';
}

}  // namespace

std::size_t SbfFramer::append(std::span<const std::uint8_t> bytes) {
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
    crc_before_[at + 1] = crc16_next(crc_before_[at], bytes[i]);
    ++end_;
  }
  return count;
}

void SbfFramer::find_starts() {
  for (; searched_ + kHeader <= end_; ++searched_) {
    const auto from = buffer_.begin() + static_cast<std::ptrdiff_t>(index(searched_));
    const auto to = buffer_.begin() + static_cast<std::ptrdiff_t>(index(end_) - kHeader + 1);
    searched_ += static_cast<Position>(std::find(from, to, kSync[0]) - from);
    if (searched_ + kHeader > end_) return;
    const std::uint8_t* p = buffer_.data() + index(searched_);
    if (p[1] != kSync[1]) continue;
    const std::size_t size = read_u2(p + 6);
    if (size < kStamped || size > kMaxSize || size % 4 != 0) {
      starts_.add_refused(searched_, kBadLength);
    } else {
      starts_.add(searched_, searched_ + size);
    }
  }
}

// The checksum of a piece of the stream follows from those before its first byte and behind its
// last, because a checksum is linear: the first one, moved on by the length of the piece, is what
// the bytes before contribute to the second.
bool SbfFramer::checksum_is_good(const MessageStarts::Candidate& candidate) const {
  static_assert(kMaxSize < std::size_t{256} * 256);
  const std::size_t start = index(candidate.start), end = index(candidate.end);
  const std::size_t first = start + kCovered;
  const std::uint16_t before = moved_on(crc_before_[first], end - first);
  const auto crc = static_cast<std::uint16_t>(crc_before_[end] ^ before);
  return crc == read_u2(buffer_.data() + start + kSync.size());
}

bool SbfFramer::next(SbfBlock* block) {
  find_starts();
  while (const auto candidate = starts_.next_whole(end_)) {
    if (checksum_is_good(*candidate)) {
      take(*candidate, block);
      return true;
    }
    starts_.refuse(*candidate, kBadChecksum);
  }
  // Bytes before the first start that still waits belong to no block.
  skip_to(finished_ ? end_ : starts_.first_waiting().value_or(std::max(searched_, begin_)));
  return false;
}

void SbfFramer::take(const MessageStarts::Candidate& candidate, SbfBlock* block) {
  skip_to(candidate.start);
  const std::uint8_t* p = buffer_.data() + index(begin_);
  block->number = read_u2(p + 4) & kNumberMask;
  block->time = time_of(read_u2(p + 12), read_u4(p + 8));
  block->payload = std::span(buffer_).subspan(index(candidate.start) + kStamped,
                                              candidate.end - candidate.start - kStamped);
  begin_ = candidate.end;
  searched_ = std::max(searched_, begin_);
  starts_.drop_before(begin_);
  ++counters_.blocks;
}

void SbfFramer::skip_to(Position position) {
  const MessageStarts::Counts none = starts_.drop_before(position);
  (finished_ ? counters_.incomplete : counters_.bad_checksums) += none[MessageStarts::kWaiting];
  counters_.bad_checksums += none[kBadChecksum];
  counters_.bad_lengths += none[kBadLength];
  const auto first = buffer_.begin() + static_cast<std::ptrdiff_t>(index(begin_));
  const auto last = buffer_.begin() + static_cast<std::ptrdiff_t>(index(position));
  counters_.text_bytes += static_cast<std::uint64_t>(std::count_if(first, last, is_text));
  counters_.bytes_skipped += position - begin_;
  begin_ = position;
  searched_ = std::max(searched_, begin_);
}

}  // namespace leonav
