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
    crc_before_[end_ + 1] = crc16_next(crc_before_[end_], bytes[i]);
    ++end_;
  }
  return count;
}

bool SbfFramer::is_sync() const {
  return buffer_[begin_] == kSync[0] && buffer_[begin_ + 1] == kSync[1];
}

// The checksum of a piece of the stream follows from those before its first byte and behind its
// last, because a checksum is linear: the first one, moved on by the length of the piece, is what
// the bytes before contribute to the second.
bool SbfFramer::checksum_is_good(std::size_t size) const {
  static_assert(kMaxSize < std::size_t{256} * 256);
  const std::size_t first = begin_ + kCovered;
  const std::uint16_t before = moved_on(crc_before_[first], size - kCovered);
  const auto crc = static_cast<std::uint16_t>(crc_before_[begin_ + size] ^ before);
  return crc == read_u2(buffer_.data() + begin_ + kSync.size());
}

void SbfFramer::describe(std::size_t size, SbfBlock* block) const {
  const std::uint8_t* p = buffer_.data() + begin_;
  block->number = read_u2(p + 4) & kNumberMask;
  block->time = time_of(read_u2(p + 12), read_u4(p + 8));
  block->payload = std::span(buffer_).subspan(begin_ + kStamped, size - kStamped);
}

bool SbfFramer::next(SbfBlock* block) {
  while (available() >= kHeader) {
    if (!is_sync()) {
      skip_to_sync();
      continue;
    }
    const std::size_t size = read_u2(buffer_.data() + begin_ + 6);
    if (size < kStamped || size > kMaxSize || size % 4 != 0) {
      ++counters_.bad_lengths;
      skip(1);
      continue;
    }
    if (available() < size) {
      if (!finished_) return false;
      ++counters_.incomplete;
      skip(1);
      continue;
    }
    if (!checksum_is_good(size)) {
      ++counters_.bad_checksums;
      skip(1);
      continue;
    }
    describe(size, block);
    begin_ += size;
    ++counters_.blocks;
    return true;
  }
  if (finished_) skip(available());
  return false;
}

void SbfFramer::skip(std::size_t count) {
  const auto first = buffer_.begin() + static_cast<std::ptrdiff_t>(begin_);
  counters_.text_bytes += static_cast<std::uint64_t>(
      std::count_if(first, first + static_cast<std::ptrdiff_t>(count), is_text));
  begin_ += count;
  counters_.bytes_skipped += count;
}

void SbfFramer::skip_to_sync() {
  const auto from = buffer_.begin() + static_cast<std::ptrdiff_t>(begin_) + 1;
  const auto found = std::find(from, buffer_.begin() + static_cast<std::ptrdiff_t>(end_), kSync[0]);
  skip(static_cast<std::size_t>(found - from) + 1);
}

}  // namespace leonav
