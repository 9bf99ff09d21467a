// This unit decodes the data bits of GPS LNAV subframes, which receivers hand out with or without
// parity. Source: IS-GPS-200N, 20.3.3 (figures 20-1, tables 20-I to 20-III).
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "core/gnss/orbits/ephemeris.h"

namespace leonav {

// The data bits of one subframe: ten words of 24 bits, without parity.
using GpsLnavBits = std::array<std::uint8_t, 30>;

// What a subframe says of itself.
struct GpsLnavHead {
  std::uint32_t number = 0;     // 1 to 5 of a whole subframe
  std::int64_t sent_tow_s = 0;  // time of week of its first bit, s; -6 at the end of a week
};

// Reads the first two words; nullopt if the preamble is wrong or the time of week does not exist.
std::optional<GpsLnavHead> read_gps_lnav_head(const GpsLnavBits& subframe);

// Returns whether the week of subframe 1 can be that of `time`.
bool gps_lnav_week_agrees(const GpsLnavBits& subframe1, GpsTime time);

// Returns whether subframes 1 to 3 are of one issue: a change within the set appears as different
// numbers (20.3.3.4.1).
bool gps_lnav_issues_agree(const GpsLnavBits& subframe1, const GpsLnavBits& subframe2,
                           const GpsLnavBits& subframe3);

// Decodes subframes 1 to 3. Reference times are those nearest to `transmission_time`, which the
// result keeps.
Ephemeris decode_gps_lnav(SatelliteId satellite, GpsTime transmission_time,
                          const GpsLnavBits& subframe1, const GpsLnavBits& subframe2,
                          const GpsLnavBits& subframe3);

}  // namespace leonav
