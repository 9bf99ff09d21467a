// This header defines what the decoders of all navigation messages share: where a subframe
// comes from and what became of it.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/gps_time.h"
#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "drivers/binary/correction_page.h"

namespace leonav {

// Result of one subframe: the set that it completed, if any, or the page of corrections that it is.
struct NavigationUpdate {
  std::optional<Ephemeris> ephemeris;
  std::optional<KlobucharModel> klobuchar;
  std::optional<CorrectionPage> page;
  std::vector<SignalBias> biases;  // group delays of CNAV or B-CNAV
};

// Outcome of one subframe.
enum class SubframeStatus : std::uint8_t {
  kUsed = 0,
  kOtherMessage,    // well-formed, but not a message that leonav reads
  kBadParity,       // parity, CRC or fixed bits wrong
  kBadWeek,         // its week number contradicts the receiver's
  kWrongSatellite,  // it names another satellite than the receiver does
};

// Source of one subframe. `now` is the receiver's time, or that of its last epoch.
struct SubframeOrigin {
  SatelliteId satellite;
  GpsTime now;
};

// Parts of one ephemeris may be received this far apart. It is below the least time after which an
// issue number is used again (GPS IODE: six hours, IS-GPS-200 20.3.4.4).
inline constexpr double kMaxSetAge_s = 3600.0;

// Returns whether two parts received at these times may belong to one set.
inline bool are_contemporary(GpsTime a, GpsTime b) {
  const double age_s = seconds_between(a, b);
  return a.is_set() && b.is_set() && age_s > -kMaxSetAge_s && age_s < kMaxSetAge_s;
}

}  // namespace leonav
