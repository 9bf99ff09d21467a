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
    crc_before_[end_ + 1] = crc32_next(crc_before_[end_], bytes[i]);
    ++end_;
  }
  return count;
}

bool Oem7Framer::is_sync() const {
  const std::uint8_t kind = buffer_[begin_ + 2];
  return buffer_[begin_] == kSync[0] && buffer_[begin_ + 1] == kSync[1] &&
         (kind == kLongHeader || kind == kShortHeader);
}

// The long header states its own length, which later firmware may enlarge. Returns false for
// lengths that no message has. Precondition: the shorter header is there.
bool Oem7Framer::read_layout(Layout* layout) const {
  const std::uint8_t* p = buffer_.data() + begin_;
  if (p[2] == kShortHeader) {
    *layout = {kShortSize, p[3]};
    return true;
  }
  *layout = {p[3], read_u2(p + 8)};
  return layout->header >= kLongSize && layout->header <= kMaxHeader &&
         layout->payload <= kMaxPayload;
}

// The checksum of a piece of the stream follows from those before its first byte and behind its
// last, because a checksum is linear: the first one, moved on by the length of the piece, is what
// the bytes before contribute to the second. Over a message and its own checksum it is zero.
bool Oem7Framer::checksum_is_good(std::size_t size) const {
  static_assert(kMaxSize < std::size_t{256} * 256);
  return moved_on(crc_before_[begin_], size) == crc_before_[begin_ + size];
}

void Oem7Framer::describe(const Layout& layout, Oem7Message* message) const {
  const std::uint8_t* p = buffer_.data() + begin_;
  const bool is_short = p[2] == kShortHeader;
  *message = {};
  message->id = read_u2(p + 4);
  message->payload = std::span(buffer_).subspan(begin_ + layout.header, layout.payload);
  if (is_short) {
    message->time = time_of(read_u2(p + 6), read_u4(p + 8));
    return;
  }
  message->source = p[6] & 0x1F;
  message->is_response = (p[6] & 0x80) != 0;
  if (p[13] > kTimeUnknown) message->time = time_of(read_u2(p + 14), read_u4(p + 16));
}

bool Oem7Framer::next(Oem7Message* message) {
  while (available() >= kShortSize) {
    if (!is_sync()) {
      skip_to_sync();
      continue;
    }
    Layout layout;
    if (!read_layout(&layout)) {
      ++counters_.bad_headers;
      skip(1);
      continue;
    }
    if (available() < layout.size()) {
      if (!finished_) return false;
      ++counters_.incomplete;
      skip(1);
      continue;
    }
    if (!checksum_is_good(layout.size())) {
      ++counters_.bad_checksums;
      skip(1);
      continue;
    }
    describe(layout, message);
    begin_ += layout.size();
    ++counters_.messages;
    return true;
  }
  if (finished_) skip(available());
  return false;
}

void Oem7Framer::skip(std::size_t count) {
  const auto first = buffer_.begin() + static_cast<std::ptrdiff_t>(begin_);
  counters_.text_bytes += static_cast<std::uint64_t>(
      std::count_if(first, first + static_cast<std::ptrdiff_t>(count), is_text));
  begin_ += count;
  counters_.bytes_skipped += count;
}

void Oem7Framer::skip_to_sync() {
  const auto from = buffer_.begin() + static_cast<std::ptrdiff_t>(begin_) + 1;
  const auto found = std::find(from, buffer_.begin() + static_cast<std::ptrdiff_t>(end_), kSync[0]);
  skip(static_cast<std::size_t>(found - from) + 1);
}

}  // namespace leonav
