#include "drivers/vectornav/vectornav_framer.h"

#include <algorithm>

#include "drivers/binary/crc16.h"

namespace leonav {
namespace {

constexpr std::uint8_t kSync = 0xFA;

// Returns the product of two polynomials over GF(2), modulo the checksum's polynomial.
constexpr std::uint16_t multiply(std::uint16_t a, std::uint16_t b) {
  std::uint16_t product = 0;
  for (int bit = 15; bit >= 0; --bit) {
    const bool carries = (product & 0x8000) != 0;
    product = static_cast<std::uint16_t>(product << 1);
    if (carries) product ^= 0x1021;
    if ((b >> bit & 1) != 0) product ^= a;
  }
  return product;
}
static_assert(multiply(0x8000, 2) == 0x1021);

}  // namespace

VectornavFramer::VectornavFramer() {
  power_[0] = 1;
  for (std::size_t n = 1; n < power_.size(); ++n) power_[n] = multiply(power_[n - 1], 0x100);
}

std::size_t VectornavFramer::append(std::span<const std::uint8_t> bytes) {
  if (begin_ > 0 && end_ + bytes.size() > kCapacity) {
    std::copy(buffer_.begin() + begin_, buffer_.begin() + end_, buffer_.begin());
    std::copy(crc_.begin() + begin_, crc_.begin() + end_, crc_.begin());
    end_ -= begin_;
    begin_ = 0;
  }
  const std::size_t count = std::min(bytes.size(), kCapacity - end_);
  for (std::size_t i = 0; i < count; ++i) {
    buffer_[end_] = bytes[i];
    last_crc_ = crc16_next(last_crc_, bytes[i]);
    crc_[end_] = last_crc_;
    ++end_;
  }
  return count;
}

// The sync byte is not under the checksum; over the rest and the transmitted checksum it is zero.
// It follows from the running one: C(first..last) = C(last) - C(first - 1) x^(8 n), where minus is
// the exclusive or. A candidate therefore costs the same whatever its masks claim, and a stream
// full of false sync bytes cannot make the search slow.
bool VectornavFramer::checksum_is_good(std::size_t first, std::size_t count) const {
  return crc_[first + count - 1] == multiply(crc_[first - 1], power_[count]);
}

bool VectornavFramer::next(VectornavMessage* message) {
  while (begin_ < end_) {
    if (buffer_[begin_] != kSync) {
      skip_to_sync();
      continue;
    }
    const std::span<const std::uint8_t> rest(buffer_.data() + begin_, end_ - begin_);
    VectornavExtent extent;
    const VectornavHeader header = read_vectornav_header(rest, &extent);
    if (header == VectornavHeader::kUnknownField) {
      ++counters_.unknown_fields;
      skip(1);
      continue;
    }
    const std::size_t total = extent.total_bytes();
    if (header == VectornavHeader::kIncomplete || rest.size() < total) {
      if (!finished_) return false;
      ++counters_.incomplete;
      skip(1);
      continue;
    }
    if (!checksum_is_good(begin_ + 1, total - 1)) {
      ++counters_.bad_checksums;
      skip(1);
      continue;
    }
    *message = {rest.first(total), extent};
    begin_ += total;
    ++counters_.messages;
    return true;
  }
  return false;
}

void VectornavFramer::skip(std::size_t count) {
  begin_ += count;
  counters_.bytes_skipped += count;
}

void VectornavFramer::skip_to_sync() {
  const auto from = buffer_.begin() + begin_;
  skip(static_cast<std::size_t>(std::find(from, buffer_.begin() + end_, kSync) - from));
}

}  // namespace leonav
