#include "drivers/xsens/xsens_framer.h"

#include <algorithm>

#include "drivers/binary/big_endian.h"
#include "drivers/xsens/data_groups.h"

namespace leonav {
namespace {

constexpr std::uint8_t kPreamble = 0xFA;
constexpr std::uint8_t kBus = 0xFF;         // a sensor by itself
constexpr std::uint8_t kLongLength = 0xFF;  // the length follows in two bytes

}  // namespace

std::size_t XsensFramer::append(std::span<const std::uint8_t> bytes) {
  if (begin_ > 0 && end_ + bytes.size() > kCapacity) {
    std::copy(buffer_.begin() + begin_, buffer_.begin() + end_, buffer_.begin());
    std::copy(sum_.begin() + begin_, sum_.begin() + end_, sum_.begin());
    end_ -= begin_;
    begin_ = 0;
  }
  const std::size_t count = std::min(bytes.size(), kCapacity - end_);
  for (std::size_t i = 0; i < count; ++i) {
    buffer_[end_] = bytes[i];
    last_sum_ = static_cast<std::uint8_t>(last_sum_ + bytes[i]);
    sum_[end_] = last_sum_;
    ++end_;
  }
  return count;
}

XsensFramer::Header XsensFramer::read_header(std::size_t* header, std::size_t* payload) const {
  const std::uint8_t* p = buffer_.data() + begin_;
  const std::size_t size = end_ - begin_;
  if (size >= 2 && p[1] != kBus) return Header::kImpossible;
  if (size < kShortHeader) return Header::kIncomplete;
  *header = kShortHeader;
  *payload = p[3];
  if (p[3] != kLongLength) return Header::kComplete;
  if (p[2] != kMtData2) return Header::kImpossible;
  if (size < kLongHeader) return Header::kIncomplete;
  *header = kLongHeader;
  *payload = read_big_u2(p + 4);
  return *payload > kMaxShort && *payload <= kMaxPayload ? Header::kComplete : Header::kImpossible;
}

// All bytes but the preamble, with the checksum, add up to zero modulo 256. The sum follows from
// running ones, so that a candidate costs the same whatever length it claims.
bool XsensFramer::checksum_is_good(std::size_t total) const {
  return sum_[begin_ + total - 1] == sum_[begin_];
}

bool XsensFramer::next(XsensMessage* message) {
  while (begin_ < end_) {
    if (buffer_[begin_] != kPreamble) {
      skip_to_preamble();
      continue;
    }
    std::size_t header = 0, length = 0;
    const Header kind = read_header(&header, &length);
    if (kind == Header::kImpossible) {
      ++counters_.bad_lengths;
      skip(1);
      continue;
    }
    const std::size_t total = header + length + kChecksum;
    if (kind == Header::kIncomplete || end_ - begin_ < total) {
      if (!finished_) return false;
      ++counters_.incomplete;
      skip(1);
      continue;
    }
    if (!checksum_is_good(total)) {
      ++counters_.bad_checksums;
      skip(1);
      continue;
    }
    const auto payload = std::span<const std::uint8_t>(buffer_).subspan(begin_ + header, length);
    if (buffer_[begin_ + 2] == kMtData2 && !DataGroups::fill(payload)) {
      ++counters_.bad_groups;
      skip(1);
      continue;
    }
    *message = {buffer_[begin_ + 2], payload};
    begin_ += total;
    ++counters_.messages;
    return true;
  }
  return false;
}

void XsensFramer::skip(std::size_t count) {
  begin_ += count;
  counters_.bytes_skipped += count;
}

void XsensFramer::skip_to_preamble() {
  const auto from = buffer_.begin() + begin_;
  skip(static_cast<std::size_t>(std::find(from, buffer_.begin() + end_, kPreamble) - from));
}

}  // namespace leonav
