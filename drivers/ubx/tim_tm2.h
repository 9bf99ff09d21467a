// This unit decodes UBX-TIM-TM2 (0x0D 0x03), the times of pulses at an input of the receiver.
// Source: u-blox ZED-F9P interface description UBX-22008968, section 3.19.1.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/gps_time.h"

namespace leonav {

// The edges that have come since the message before. Times in UTC, which the receiver gives where
// it is configured so, are turned into GPS time by the known leap seconds; times of another system
// are taken as GPS time.
struct TimeMark {
  int input = 0;                   // 0: EXTINT0, 1: EXTINT1
  std::uint16_t rising_edges = 0;  // since the receiver's start, modulo 65536
  std::optional<GpsTime> rising, falling;
  double accuracy_s = 0.0;  // the receiver's estimate, taken as 1 sigma
};

// Counts of messages.
struct TimTm2Counters {
  std::uint64_t marks = 0;
  std::uint64_t bad_length = 0;
  std::uint64_t without_time = 0;  // the receiver has no fix, or gives its own time
  std::uint64_t without_edge = 0;  // no new edge
  std::uint64_t bad_time = 0;      // week, time of week or fraction that is impossible
};

class TimTm2Decoder {
 public:
  // nullopt: no edge with a time; counted by its reason.
  std::optional<TimeMark> decode(std::span<const std::uint8_t> payload);
  const TimTm2Counters& counters() const { return counters_; }

 private:
  TimTm2Counters counters_;
};

}  // namespace leonav
