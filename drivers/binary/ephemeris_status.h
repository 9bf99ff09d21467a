// This header names and counts what can become of a message that holds a set of broadcast elements.
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
  kNotSane,       // elements outside physical bounds, or one is missing
};

// Counts of messages of which no ephemeris was made, by status.
struct EphemerisRefusals {
  std::uint64_t bad_length = 0, bad_satellite = 0, bad_time = 0, bad_week = 0, bad_subframes = 0,
                not_sane = 0;

  // Counts one message; returns whether it is kOk.
  bool count(EphemerisStatus status) {
    switch (status) {
      case EphemerisStatus::kOk:
        return true;
      case EphemerisStatus::kBadLength:
        ++bad_length;
        break;
      case EphemerisStatus::kBadSatellite:
        ++bad_satellite;
        break;
      case EphemerisStatus::kBadTime:
        ++bad_time;
        break;
      case EphemerisStatus::kBadWeek:
        ++bad_week;
        break;
      case EphemerisStatus::kBadSubframes:
        ++bad_subframes;
        break;
      case EphemerisStatus::kNotSane:
        ++not_sane;
        break;
    }
    return false;
  }
};

}  // namespace leonav
