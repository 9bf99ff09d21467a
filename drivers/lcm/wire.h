// Encoder and Decoder share the schema version, limits, and byte offsets of the messages.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/gps_time.h"

namespace leonav::wire {

inline constexpr std::int32_t kSchema = 1;

// No message that follows lcmtypes/ is longer: the largest is epoch_t at full capacity (31.4 KiB).
inline constexpr std::size_t kMaxMessageBytes = 40 * 1024;

// Times beyond week 10000 (year 2171) are nonsense and would near the end of the 64-bit range.
inline constexpr std::int64_t kMaxTimeNs = 10'000 * kNanosecondsPerWeek;

// Encoded layout (LCM: fingerprint, then the members in order, big endian, unpadded). The counts
// come before the arrays, so that they can be checked before the generated decoder, which resizes
// its vectors by any count in the message, is called.
inline constexpr std::size_t kSchemaOffset = 24;  // after fingerprint, time_ns, sequence
inline constexpr std::size_t kFirstCountOffset = 28;
inline constexpr std::size_t kEventStageOffset = 28;
inline constexpr std::size_t kDecisionMailboxOffset = 36;

inline constexpr std::uint8_t kFlagLossOfLock = 1;
inline constexpr std::uint8_t kFlagHalfCycle = 2;

inline constexpr std::uint8_t kFlagClockEvent = 1;
inline constexpr std::uint8_t kFlagManeuver = 2;
inline constexpr std::uint8_t kFlagClockPredicted = 4;
inline constexpr std::uint8_t kFlagOrbitPredicted = 8;

// Big endian; `bytes` must hold offset + 4.
inline std::uint32_t read_uint32(std::span<const std::uint8_t> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[offset + i];
  return value;
}

}  // namespace leonav::wire
