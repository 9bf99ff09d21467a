#include "drivers/vectornav/vectornav_framer.h"

#include <algorithm>

#include "drivers/binary/crc16.h"

namespace leonav {
namespace {

constexpr std::uint8_t kSync = 0xFA;

using Powers = std::array<std::uint16_t, kMaxVectornavMessage + 1>;

// Entry n is what n bytes of zeros make of the checksum 1: x^(8n) modulo the polynomial.
constexpr Powers byte_powers() {
  Powers powers{};
  powers[0] = 1;
  for (std::size_t n = 1; n < powers.size(); ++n) powers[n] = crc16_next(powers[n - 1], 0);
  return powers;
}
constexpr Powers kBytePowers = byte_powers();

}  // namespace

std::size_t VectornavFramer::append(std::span<const std::uint8_t> bytes) {
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

VectornavHeader VectornavFramer::read_header(Position start, VectornavExtent* extent) const {
  return read_vectornav_header(std::span(buffer_).subspan(index(start), end_ - start), extent);
}

// A header is of 4 to 16 bytes. One that is not whole yet is looked at again with more bytes, which
// holds up no message before it.
void VectornavFramer::find_starts() {
  for (; searched_ < end_; ++searched_) {
    const auto from = buffer_.begin() + static_cast<std::ptrdiff_t>(index(searched_));
    const auto to = buffer_.begin() + static_cast<std::ptrdiff_t>(index(end_));
    searched_ += static_cast<Position>(std::find(from, to, kSync) - from);
    if (searched_ == end_) return;
    VectornavExtent extent;
    const VectornavHeader header = read_header(searched_, &extent);
    if (header == VectornavHeader::kComplete) {
      starts_.add(searched_, searched_ + extent.total_bytes());
    } else if (header == VectornavHeader::kUnknownField) {
      starts_.add_refused(searched_, kUnknownField);
    } else if (finished_) {
      starts_.add_refused(searched_, kCutOff);
    } else {
      return;
    }
  }
}

// The sync byte is not under the checksum; over the rest and the transmitted checksum it is zero.
// The checksum of a piece of the stream follows from those before its first byte and behind its
// last, because a checksum is linear: the first one, moved on by the length of the piece, is what
// the bytes before contribute to the second.
bool VectornavFramer::checksum_is_good(const MessageStarts::Candidate& candidate) const {
  const std::size_t first = index(candidate.start) + 1, end = index(candidate.end);
  return crc16_product(crc_before_[first], kBytePowers[end - first]) == crc_before_[end];
}

bool VectornavFramer::has_known_header(Position start) const {
  const std::span bytes = std::span(buffer_).subspan(index(start), end_ - start);
  return std::any_of(known_headers_.begin(), known_headers_.end(), [&](const Header& header) {
    return header.size > 0 && header.size <= bytes.size() &&
           std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(header.size),
                      header.bytes.begin());
  });
}

void VectornavFramer::remember_header(Position start, std::size_t size) {
  if (has_known_header(start)) return;
  Header& header = known_headers_[oldest_header_];
  oldest_header_ = (oldest_header_ + 1) % known_headers_.size();
  header.size = size;
  std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(index(start)), size,
              header.bytes.begin());
}

std::optional<MessageStarts::Candidate> VectornavFramer::next_candidate() {
  const auto first = starts_.first_waiting();
  if (!first) return std::nullopt;
  skip_to(*first);  // bytes before the first start that still waits belong to no message
  if (has_known_header(begin_)) {
    VectornavExtent extent;
    read_header(begin_, &extent);
    const MessageStarts::Candidate outer{begin_, begin_ + extent.total_bytes()};
    if (outer.end <= end_) return outer;
    if (!finished_) return std::nullopt;
  }
  return starts_.next_whole(end_);
}

bool VectornavFramer::next(VectornavMessage* message) {
  find_starts();
  while (const auto candidate = next_candidate()) {
    if (checksum_is_good(*candidate)) {
      take(*candidate, message);
      return true;
    }
    starts_.refuse(*candidate, kBadChecksum);
  }
  skip_to(finished_ ? end_ : starts_.first_waiting().value_or(std::max(searched_, begin_)));
  return false;
}

void VectornavFramer::take(const MessageStarts::Candidate& candidate, VectornavMessage* message) {
  skip_to(candidate.start);
  read_header(candidate.start, &message->extent);
  remember_header(candidate.start, message->extent.header_bytes);
  message->bytes =
      std::span(buffer_).subspan(index(candidate.start), candidate.end - candidate.start);
  begin_ = candidate.end;
  searched_ = std::max(searched_, begin_);
  starts_.drop_before(begin_);
  ++counters_.messages;
}

void VectornavFramer::skip_to(Position position) {
  const MessageStarts::Counts none = starts_.drop_before(position);
  (finished_ ? counters_.incomplete : counters_.bad_checksums) += none[MessageStarts::kWaiting];
  counters_.bad_checksums += none[kBadChecksum];
  counters_.unknown_fields += none[kUnknownField];
  counters_.incomplete += none[kCutOff];
  counters_.bytes_skipped += position - begin_;
  begin_ = position;
  searched_ = std::max(searched_, begin_);
}

}  // namespace leonav
