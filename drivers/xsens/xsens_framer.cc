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
  if (begin_ > base_ && index(end_) + bytes.size() > kCapacity) {
    const auto first = static_cast<std::ptrdiff_t>(index(begin_));
    const auto last = static_cast<std::ptrdiff_t>(index(end_));
    std::copy(buffer_.begin() + first, buffer_.begin() + last, buffer_.begin());
    std::copy(sum_.begin() + first, sum_.begin() + last, sum_.begin());
    base_ = begin_;
  }
  const std::size_t count = std::min(bytes.size(), kCapacity - index(end_));
  for (std::size_t i = 0; i < count; ++i) {
    buffer_[index(end_)] = bytes[i];
    last_sum_ = static_cast<std::uint8_t>(last_sum_ + bytes[i]);
    sum_[index(end_)] = last_sum_;
    ++end_;
  }
  return count;
}

XsensFramer::Header XsensFramer::read_header(Position start, std::size_t* header,
                                             std::size_t* payload) const {
  const std::uint8_t* p = buffer_.data() + index(start);
  const std::size_t size = end_ - start;
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

void XsensFramer::find_starts() {
  for (; searched_ < end_; ++searched_) {
    const auto from = buffer_.begin() + static_cast<std::ptrdiff_t>(index(searched_));
    const auto to = buffer_.begin() + static_cast<std::ptrdiff_t>(index(end_));
    searched_ += static_cast<Position>(std::find(from, to, kPreamble) - from);
    if (searched_ == end_) return;
    std::size_t header = 0, payload = 0;
    const Header kind = read_header(searched_, &header, &payload);
    if (kind == Header::kIncomplete) return;
    if (kind == Header::kImpossible) {
      starts_.add_refused(searched_, kBadLength);
    } else {
      starts_.add(searched_, searched_ + header + payload + kChecksum);
    }
  }
}

std::span<const std::uint8_t> XsensFramer::payload_of(
    const MessageStarts::Candidate& candidate) const {
  const std::size_t start = index(candidate.start);
  const std::size_t header = buffer_[start + 3] == kLongLength ? kLongHeader : kShortHeader;
  return std::span(buffer_).subspan(start + header,
                                    index(candidate.end) - start - header - kChecksum);
}

// All bytes but the preamble, with the checksum, add up to zero modulo 256. The sum follows from
// running ones, so that a candidate costs the same whatever length it claims.
std::size_t XsensFramer::fault_of(const MessageStarts::Candidate& candidate) const {
  const std::size_t start = index(candidate.start);
  if (sum_[index(candidate.end) - 1] != sum_[start]) return kBadChecksum;
  if (buffer_[start + 2] == kMtData2) {
    return DataGroups::fill(payload_of(candidate)) ? MessageStarts::kWaiting : kBadGroups;
  }
  return candidate.start == begin_ ? MessageStarts::kWaiting : kBadChecksum;
}

bool XsensFramer::next(XsensMessage* message) {
  find_starts();
  while (const auto candidate = starts_.next_whole(end_)) {
    skip_to(starts_.first_waiting().value_or(begin_));  // the candidate waits, or one before it
    const std::size_t fault = fault_of(*candidate);
    if (fault == MessageStarts::kWaiting) {
      take(*candidate, message);
      return true;
    }
    starts_.refuse(*candidate, fault);
  }
  // Bytes before the first start that still waits belong to no message.
  skip_to(finished_ ? end_ : starts_.first_waiting().value_or(std::max(searched_, begin_)));
  return false;
}

void XsensFramer::take(const MessageStarts::Candidate& candidate, XsensMessage* message) {
  skip_to(candidate.start);
  *message = {buffer_[index(candidate.start) + 2], payload_of(candidate)};
  begin_ = candidate.end;
  searched_ = std::max(searched_, begin_);
  starts_.drop_before(begin_);
  ++counters_.messages;
}

void XsensFramer::skip_to(Position position) {
  const MessageStarts::Counts none = starts_.drop_before(position);
  (finished_ ? counters_.incomplete : counters_.bad_checksums) += none[MessageStarts::kWaiting];
  counters_.bad_checksums += none[kBadChecksum];
  counters_.bad_lengths += none[kBadLength];
  counters_.bad_groups += none[kBadGroups];
  counters_.bytes_skipped += position - begin_;
  begin_ = position;
  searched_ = std::max(searched_, begin_);
}

}  // namespace leonav
