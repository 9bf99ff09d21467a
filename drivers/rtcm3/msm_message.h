// This unit takes a multiple signal message apart into its fields, which stay whole numbers.
// Source: RTCM 10403.3, 3.5.16 and tables 3.5-78 to 3.5-88.
#pragma once
#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/rtcm3/msm_type.h"

namespace leonav {

inline constexpr std::size_t kMsmCells = 64;  // the most that a message may have

// What all cells of a message share.
struct MsmHeader {
  MsmType type;
  std::uint16_t station = 0;  // DF003
  // Milliseconds of the system's own week (DF004, DF248, DF427); GLONASS: day and time of day.
  std::uint32_t epoch_ms = 0;
  bool more_follow = false;  // DF393: further messages of this epoch and station follow
};

// One satellite.
struct MsmSatellite {
  std::uint8_t number = 0;                  // bit of the mask, from 1
  std::optional<std::int32_t> rough_range;  // DF397, DF398; 2^-10 ms of light
  std::optional<std::int32_t> rough_rate;   // DF399; m/s
};

// One signal of one satellite; an empty value was not measured.
struct MsmCell {
  std::uint8_t satellite = 0;              // index into MsmMessage::satellites
  std::uint8_t signal = 0;                 // bit of the signal mask, from 1
  std::optional<std::int32_t> fine_range;  // DF400, DF405; 2^-29 ms
  std::optional<std::int32_t> fine_phase;  // DF401, DF406; 2^-31 ms
  std::optional<std::int32_t> fine_rate;   // DF404; 0.1 mm/s
  std::int64_t least_lock_ms = 0;          // DF402, DF407
  bool half_cycle_ambiguous = false;       // DF420
  std::uint32_t cn0 = 0;                   // DF403, DF408; 2^-4 dB-Hz, 0: unknown
};

// A whole message.
struct MsmMessage {
  MsmHeader header;
  boost::container::static_vector<MsmSatellite, kMsmCells> satellites;
  boost::container::static_vector<MsmCell, kMsmCells> cells;  // by satellite, then by signal
};

// Outcome of taking a message apart.
enum class MsmStatus : std::uint8_t {
  kOk = 0,
  kBadLength,  // shorter than its masks require
  kBadMask,    // satellites times signals above 64
};

// Reads what stands at the same place in every MSM, also of a system or format that is not used.
// Returns nullopt if the message is shorter than that.
std::optional<MsmHeader> read_msm_header(const MsmType& type,
                                         std::span<const std::uint8_t> message);

// Reads a whole message of format 4 to 7. Bits behind the last cell are filling.
MsmStatus read_msm(const MsmType& type, std::span<const std::uint8_t> message, MsmMessage* result);

}  // namespace leonav
