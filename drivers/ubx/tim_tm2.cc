#include "drivers/ubx/tim_tm2.h"

#include "core/base/calendar.h"
#include "drivers/binary/little_endian.h"

namespace leonav {
namespace {

constexpr std::size_t kSize = 28;
constexpr std::uint8_t kNewFalling = 1 << 2, kTimeIsValid = 1 << 6, kNewRising = 1 << 7;
constexpr int kReceiverTime = 0, kUtc = 2;  // of the time base in bits 3 and 4
constexpr std::uint8_t kUtcIsKnown = 1 << 5;
constexpr std::uint32_t kMillisecondsPerWeek = 604'800'000, kNanosecondsPerMillisecond = 1'000'000;

std::optional<GpsTime> edge_time(int week, std::uint32_t tow_ms, std::uint32_t tow_ns,
                                 bool is_utc) {
  if (week < 1 || week > kLastGpsWeek || tow_ms >= kMillisecondsPerWeek ||
      tow_ns >= kNanosecondsPerMillisecond) {
    return std::nullopt;
  }
  const GpsTime time = GpsTime::from_nanoseconds(
      week * kNanosecondsPerWeek + std::int64_t{tow_ms} * kNanosecondsPerMillisecond + tow_ns);
  return is_utc ? gps_from_utc(time) : time;
}

}  // namespace

std::optional<TimeMark> TimTm2Decoder::decode(std::span<const std::uint8_t> payload) {
  if (payload.size() != kSize) {
    ++counters_.bad_length;
    return std::nullopt;
  }
  const std::uint8_t* p = payload.data();
  const std::uint8_t flags = p[1];
  const int base = (flags >> 3) & 3;
  const bool is_utc = base == kUtc;
  if ((flags & kTimeIsValid) == 0 || base == kReceiverTime || base > kUtc ||
      (is_utc && (flags & kUtcIsKnown) == 0)) {
    ++counters_.without_time;
    return std::nullopt;
  }
  if ((flags & (kNewRising | kNewFalling)) == 0) {
    ++counters_.without_edge;
    return std::nullopt;
  }
  TimeMark mark;
  mark.input = p[0];
  mark.rising_edges = read_u2(p + 2);
  mark.accuracy_s = read_u4(p + 24) * 1e-9;
  if ((flags & kNewRising) != 0) {
    mark.rising = edge_time(read_u2(p + 4), read_u4(p + 8), read_u4(p + 12), is_utc);
  }
  if ((flags & kNewFalling) != 0) {
    mark.falling = edge_time(read_u2(p + 6), read_u4(p + 16), read_u4(p + 20), is_utc);
  }
  if (!mark.rising && !mark.falling) {
    ++counters_.bad_time;
    return std::nullopt;
  }
  ++counters_.marks;
  return mark;
}

}  // namespace leonav
