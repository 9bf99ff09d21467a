// This unit decodes SSR messages of RTCM (1057 to 1062, 1240 to 1245, 1258 to 1263, 1265, 1267,
// 1270) and of the IGS (4076) for GPS, Galileo and BeiDou.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/ssr/ssr_correction.h"

namespace leonav {

// How the fields of a message are laid out.
struct SsrType {
  SsrKind kind = SsrKind::kOrbit;
  System system = System::kGps;
  bool is_igs = false;
};

// Returns the type of a message, or nullopt if it is no SSR message of a system that is used. The
// IGS's types stand within the message.
std::optional<SsrType> ssr_type(std::uint16_t message_number,
                                std::span<const std::uint8_t> message);

// Outcome of one message.
enum class SsrStatus : std::uint8_t {
  kOk = 0,
  kBadLength,  // shorter than its satellites require
  kBadTime,    // time beyond the end of the week
};

// Counts of what a message holds and cannot be named.
struct SsrLeftOut {
  std::uint64_t satellites = 0;  // number outside the system's range
  std::uint64_t signals = 0;     // identifier without a RINEX code
};

// Decodes one message; its time is completed to the instant nearest to `near`, which must be set.
SsrStatus read_ssr(const SsrType& type, std::span<const std::uint8_t> message, GpsTime near,
                   SsrMessage* result, SsrLeftOut* left_out);

}  // namespace leonav
