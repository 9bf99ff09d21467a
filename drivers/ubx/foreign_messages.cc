#include "drivers/ubx/foreign_messages.h"

#include "drivers/binary/crc24q.h"

namespace leonav {
namespace {

// NMEA 0183 allows 82 characters, u-blox's extended sentences go beyond.
constexpr std::size_t kMaxSentence = 256;
constexpr std::uint8_t kRtcm3Preamble = 0xD3;  // RTCM 10403.3, 4.1: preamble, 6 zeros, 10 of length
constexpr std::size_t kRtcm3Overhead = 6;

int hexadecimal(std::uint8_t c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

}  // namespace

void ForeignMessages::take(std::uint8_t byte) {
  switch (kind_) {
    case Kind::kNone:
      begin(byte);
      return;
    case Kind::kNmea:
      take_nmea(byte);
      return;
    case Kind::kRtcm3:
      take_rtcm3(byte);
      return;
  }
}

void ForeignMessages::begin(std::uint8_t byte) {
  kind_ = byte == '$' ? Kind::kNmea : byte == kRtcm3Preamble ? Kind::kRtcm3 : Kind::kNone;
  size_ = 1;
  star_ = 0;
  length_ = 0;
  stated_checksum_ = 0;
  checksum_ = kind_ == Kind::kRtcm3 ? crc24q_next(0, byte) : 0;
}

// A sentence is: $, text, *, two hexadecimal digits, carriage return, line feed; the checksum is
// over the text.
void ForeignMessages::take_nmea(std::uint8_t byte) {
  ++size_;
  const std::size_t after_star = star_ == 0 ? 0 : size_ - star_;
  bool fits = size_ <= kMaxSentence;
  if (star_ == 0) {
    fits = fits && byte >= ' ' && byte <= '~' && byte != '$';
    if (byte == '*') {
      star_ = size_;
    } else {
      checksum_ ^= byte;
    }
  } else if (after_star <= 2) {
    const int digit = hexadecimal(byte);
    fits = digit >= 0;
    stated_checksum_ = stated_checksum_ * 16 + static_cast<std::uint32_t>(digit);
  } else {
    fits = byte == (after_star == 3 ? '\r' : '\n') && stated_checksum_ == checksum_;
    if (fits && after_star == 4) {
      ++counters_.nmea_sentences;
      counters_.nmea_bytes += size_;
      kind_ = Kind::kNone;
    }
  }
  if (!fits) begin(byte);
}

void ForeignMessages::take_rtcm3(std::uint8_t byte) {
  ++size_;
  checksum_ = crc24q_next(checksum_, byte);
  if (size_ == 2) {
    if ((byte & 0xFC) != 0) return begin(byte);
    length_ = std::size_t{byte} << 8;
  } else if (size_ == 3) {
    length_ += byte + kRtcm3Overhead;
  } else if (size_ == length_) {
    // A CRC computed over a frame and its own checksum is zero.
    if (checksum_ != 0) return begin(byte);
    ++counters_.rtcm3_frames;
    counters_.rtcm3_bytes += size_;
    kind_ = Kind::kNone;
  }
}

}  // namespace leonav
