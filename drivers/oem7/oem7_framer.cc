#include "drivers/oem7/oem7_framer.h"

#include <algorithm>

#include "drivers/binary/little_endian.h"
#include "drivers/oem7/crc32.h"

namespace leonav {
namespace {

constexpr std::array<std::uint8_t, 2> kSync = {0xAA, 0x44};
constexpr std::uint8_t kLongHeader = 0x12, kShortHeader = 0x13;
constexpr std::size_t kLongSize = 28, kShortSize = 12;
constexpr std::uint8_t kTimeUnknown = 20;  // time status UNKNOWN
constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
constexpr int kMaxWeek = 8191;  // the year 2137

// Checksums that 1 becomes by n and by 256 n bytes of zeros.
struct Powers {
  std::array<std::uint32_t, 256> ones{}, pages{};
};
constexpr Powers powers_of_byte() {
  Powers powers;
  powers.ones[0] = powers.pages[0] = 0x80000000;
  for (std::size_t n = 1; n < powers.ones.size(); ++n) {
    powers.ones[n] = crc32_next(powers.ones[n - 1], 0);
  }
  const std::uint32_t page = crc32_next(powers.ones[255], 0);
  for (std::size_t n = 1; n < powers.pages.size(); ++n) {
    powers.pages[n] = crc32_product(powers.pages[n - 1], page);
  }
  return powers;
}
constexpr Powers kPowers = powers_of_byte();

std::uint32_t moved_on(std::uint32_t crc, std::size_t bytes) {
  return crc32_product(crc32_product(crc, kPowers.ones[bytes % 256]), kPowers.pages[bytes / 256]);
}

GpsTime time_of(int week, std::uint32_t milliseconds) {
  if (week < 1 || week > kMaxWeek || milliseconds >= kSecondsPerWeek * 1000) return {};
  return GpsTime::from_nanoseconds(week * kNanosecondsPerWeek +
                                   milliseconds * kNanosecondsPerMillisecond);
}

bool is_text(std::uint8_t byte) {
  return (byte >= 0x20 && byte < 0x7F) || byte == '\r' || byte == '\n' || byte == '\t';
}

}  // namespace

std::size_t Oem7Framer::append(std::span<const std::uint8_t> bytes) {
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
    crc_before_[at + 1] = crc32_next(crc_before_[at], bytes[i]);
    ++end_;
  }
  return count;
}

bool Oem7Framer::is_sync(Position start) const {
  const std::uint8_t* p = buffer_.data() + index(start);
  return p[0] == kSync[0] && p[1] == kSync[1] && (p[2] == kLongHeader || p[2] == kShortHeader);
}

// The long header states its own length, which later firmware may enlarge. Returns false for
// lengths that no message has. Precondition: the shorter header is there.
bool Oem7Framer::read_layout(Position start, Layout* layout) const {
  const std::uint8_t* p = buffer_.data() + index(start);
  if (p[2] == kShortHeader) {
    *layout = {kShortSize, p[3]};
    return true;
  }
  *layout = {p[3], read_u2(p + 8)};
  return layout->header >= kLongSize && layout->header <= kMaxHeader &&
         layout->payload <= kMaxPayload;
}

void Oem7Framer::find_starts() {
  for (; searched_ + kShortSize <= end_; ++searched_) {
    const auto from = buffer_.begin() + static_cast<std::ptrdiff_t>(index(searched_));
    const auto to = buffer_.begin() + static_cast<std::ptrdiff_t>(index(end_) - kShortSize + 1);
    searched_ += static_cast<Position>(std::find(from, to, kSync[0]) - from);
    if (searched_ + kShortSize > end_) return;
    if (!is_sync(searched_)) continue;
    Layout layout;
    if (read_layout(searched_, &layout)) {
      starts_.add(searched_, searched_ + layout.size());
    } else {
      starts_.add_refused(searched_, kBadHeader);
    }
  }
}

// The checksum of a piece of the stream follows from those before its first byte and behind its
// last, because a checksum is linear: the first one, moved on by the length of the piece, is what
// the bytes before contribute to the second. Over a message and its own checksum it is zero.
bool Oem7Framer::checksum_is_good(const MessageStarts::Candidate& candidate) const {
  static_assert(kMaxSize < std::size_t{256} * 256);
  const std::size_t start = index(candidate.start), end = index(candidate.end);
  return moved_on(crc_before_[start], end - start) == crc_before_[end];
}

bool Oem7Framer::next(Oem7Message* message) {
  find_starts();
  while (const auto candidate = starts_.next_whole(end_)) {
    if (checksum_is_good(*candidate)) {
      take(*candidate, message);
      return true;
    }
    starts_.refuse(*candidate, kBadChecksum);
  }
  // Bytes before the first start that still waits belong to no message.
  skip_to(finished_ ? end_ : starts_.first_waiting().value_or(std::max(searched_, begin_)));
  return false;
}

void Oem7Framer::take(const MessageStarts::Candidate& candidate, Oem7Message* message) {
  skip_to(candidate.start);
  const std::uint8_t* p = buffer_.data() + index(candidate.start);
  Layout layout;
  read_layout(candidate.start, &layout);
  *message = {};
  message->id = read_u2(p + 4);
  message->payload =
      std::span(buffer_).subspan(index(candidate.start) + layout.header, layout.payload);
  if (p[2] == kShortHeader) {
    message->time = time_of(read_u2(p + 6), read_u4(p + 8));
  } else {
    message->source = p[6] & 0x1F;
    message->is_response = (p[6] & 0x80) != 0;
    if (p[13] > kTimeUnknown) message->time = time_of(read_u2(p + 14), read_u4(p + 16));
  }
  begin_ = candidate.end;
  searched_ = std::max(searched_, begin_);
  starts_.drop_before(begin_);
  ++counters_.messages;
}

void Oem7Framer::skip_to(Position position) {
  const MessageStarts::Counts none = starts_.drop_before(position);
  (finished_ ? counters_.incomplete : counters_.bad_checksums) += none[MessageStarts::kWaiting];
  counters_.bad_checksums += none[kBadChecksum];
  counters_.bad_headers += none[kBadHeader];
  const auto first = buffer_.begin() + static_cast<std::ptrdiff_t>(index(begin_));
  const auto last = buffer_.begin() + static_cast<std::ptrdiff_t>(index(position));
  counters_.text_bytes += static_cast<std::uint64_t>(std::count_if(first, last, is_text));
  counters_.bytes_skipped += position - begin_;
  begin_ = position;
  searched_ = std::max(searched_, begin_);
}

}  // namespace leonav
