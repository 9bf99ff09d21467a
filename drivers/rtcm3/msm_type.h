// This unit classifies the multiple signal messages (MSM) by their number.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/gnss/signals/satellite.h"

namespace leonav {

// What the number of a multiple signal message says. Source: RTCM 10403.3, tables 3.5-78 and
// 3.5-79: 1071 to 1077 are GPS, and each further system is ten higher.
struct MsmType {
  std::optional<System> system;  // empty: one that leonav does not use
  int format = 0;                // 1 to 7
  // Formats 1 to 3 leave out the milliseconds of the range, which only a known position restores.
  bool has_full_range() const { return format >= 4; }
  bool has_rate() const { return format == 5 || format == 7; }
  bool is_fine() const { return format >= 6; }  // code, carrier and lock time with more bits
};

// Returns nullopt for a message that is no MSM.
std::optional<MsmType> msm_type(std::uint16_t message_number);

}  // namespace leonav
