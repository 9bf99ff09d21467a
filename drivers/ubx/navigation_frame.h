// This header defines what the decoders of all navigation messages share: their result, and full
// times from truncated ones.
#pragma once
#include <cstdint>
#include <optional>

#include "core/base/gps_time.h"
#include "core/gnss/orbits/ephemeris.h"

namespace leonav {

// Result of one subframe: the set that it completed, if any.
struct NavigationUpdate {
  std::optional<Ephemeris> ephemeris;
  std::optional<KlobucharModel> klobuchar;
};

// Outcome of one subframe.
enum class SubframeStatus : std::uint8_t {
  kUsed = 0,
  kOtherMessage,    // well-formed, but not a message that leonav reads
  kBadParity,       // parity, CRC or fixed bits wrong
  kBadWeek,         // its week number contradicts the receiver's
  kWrongSatellite,  // it names another satellite than the receiver does
};

// Source of one subframe. `now` is the time of the last RAWX.
struct SubframeOrigin {
  SatelliteId satellite;
  GpsTime now;
};

// Parts of one ephemeris may be received this far apart. It is below the least time after which an
// issue number is used again (GPS IODE: six hours, IS-GPS-200 20.3.4.4).
inline constexpr double kMaxSetAge_s = 3600.0;

// Returns the full week whose remainder modulo `modulus` is `truncated`, nearest to
// `reference_week`.
constexpr int full_week(int truncated, int modulus, int reference_week) {
  int difference = (truncated - reference_week) % modulus;
  if (difference < 0) difference += modulus;
  if (difference > modulus / 2) difference -= modulus;
  return reference_week + difference;
}

// Returns the instant with this time of week that is nearest to `near`.
inline GpsTime nearest_instant(std::int64_t tow_s, GpsTime near) {
  const std::int64_t start = near.week() * kNanosecondsPerWeek;
  GpsTime time = GpsTime::from_nanoseconds(start + tow_s * kNanosecondsPerSecond);
  const std::int64_t ahead = time.nanoseconds() - near.nanoseconds();
  if (ahead > kNanosecondsPerWeek / 2) time = time.plus_nanoseconds(-kNanosecondsPerWeek);
  if (ahead < -kNanosecondsPerWeek / 2) time = time.plus_nanoseconds(kNanosecondsPerWeek);
  return time;
}

// Returns whether a broadcast week number can be that of `time`: the week itself or, since receiver
// and satellite may be on two sides of a week's end, a neighbour. `offset` is week zero of the
// system's own count in GPS weeks.
constexpr bool week_agrees(int truncated, int modulus, int offset, GpsTime time) {
  const int difference = full_week(truncated + offset, modulus, time.week()) - time.week();
  return difference >= -1 && difference <= 1;
}

// Returns whether two parts received at these times may belong to one set.
inline bool are_contemporary(GpsTime a, GpsTime b) {
  const double age_s = seconds_between(a, b);
  return a.is_set() && b.is_set() && age_s > -kMaxSetAge_s && age_s < kMaxSetAge_s;
}

}  // namespace leonav
