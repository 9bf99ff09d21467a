// This header names what can become of a message that holds an ephemeris as decimals.
#pragma once
#include <cstdint>

namespace leonav {

enum class EphemerisStatus : std::uint8_t {
  kOk = 0,
  kBadLength,     // shorter than its fields
  kBadSatellite,  // number outside its system's range
  kBadTime,       // reference time beyond the end of the week
  kBadWeek,       // its week contradicts the receiver's
  kBadSubframes,  // not subframes 1 to 3 of one issue
  kNotSane,       // elements outside physical bounds
};

}  // namespace leonav
