// Encoder and Decoder share these constants: schema version, limits, and byte offsets of the
// messages.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/gps_time.h"

namespace leonav::wire {

inline constexpr std::int32_t kSchema = 1;
inline constexpr std::int32_t kCheckpointSchema = 3;    // it has a calibration since
inline constexpr std::int32_t kLeoEphemerisSchema = 2;  // on the channel of ephemeris_t
// Of HEALTH. SOLUTION, EPOCH and SMOOTHER: output_schema.h.
inline constexpr std::int32_t kHealthSchema = 2;

// Largest message that the Decoder accepts. The longest of lcmtypes/ is biases_t at full capacity
// (60.1 KiB).
inline constexpr std::size_t kMaxMessageBytes = 64 * 1024;

// No message without a list of its own is longer: imu_t, ephemeris_t, leo_ephemeris_t,
// ionosphere_t, odometer_t, command_t, signed_command_t.
inline constexpr std::size_t kMaxBytesWithoutList = 1024;

// Latest time that is accepted: week 10000 (year 2171). Later ones are wrong and near the end of
// the 64-bit range.
inline constexpr std::int64_t kMaxTimeNs = 10'000 * kNanosecondsPerWeek;

// Byte offsets in an encoded message. LCM writes the fingerprint, then the members in order, big
// endian, without padding. The messages have their counts before their arrays: the Decoder checks
// them before it calls the generated decoder, which resizes its vectors to any count in the
// message.
inline constexpr std::size_t kTimeOffset = 8;
inline constexpr std::size_t kSequenceOffset = 16;
inline constexpr std::size_t kSchemaOffset = 24;  // after fingerprint, time_ns, sequence
inline constexpr std::size_t kFirstCountOffset = 28;
inline constexpr std::size_t kEventStageOffset = 28;
inline constexpr std::size_t kEventKindOffset = 29;
inline constexpr std::size_t kEventCodeOffset = 30;
inline constexpr std::size_t kDecisionMailboxOffset = 36;

// Flags of gnss_observation_t.
inline constexpr std::uint8_t kFlagLossOfLock = 1;
inline constexpr std::uint8_t kFlagHalfCycle = 2;

// Flags of precise_state_t.
inline constexpr std::uint8_t kFlagClockEvent = 1;
inline constexpr std::uint8_t kFlagManeuver = 2;
inline constexpr std::uint8_t kFlagClockPredicted = 4;
inline constexpr std::uint8_t kFlagOrbitPredicted = 8;

// Flags of corrected_state_t.
inline constexpr std::uint8_t kFlagAtAntenna = 1;

// Reads a big-endian number. Precondition: `bytes` holds at least offset + 4 bytes.
inline std::uint32_t read_uint32(std::span<const std::uint8_t> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[offset + i];
  return value;
}

// The same of 8 bytes.
inline std::int64_t read_int64(std::span<const std::uint8_t> bytes, std::size_t offset) {
  const auto high = static_cast<std::uint64_t>(read_uint32(bytes, offset));
  return static_cast<std::int64_t>(high << 32 | read_uint32(bytes, offset + 4));
}

}  // namespace leonav::wire
