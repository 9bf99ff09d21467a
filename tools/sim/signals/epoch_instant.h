// EpochInstant holds what all satellites of one epoch share.
#pragma once
#include <array>

#include "core/earth/sun_moon.h"
#include "tools/sim/places/surroundings.h"
#include "tools/sim/signals/receiver_clock.h"
#include "tools/sim/signals/signal_path.h"

namespace leonav::sim {

// Time, clock and antenna of one epoch.
struct EpochInstant {
  double t_tag = 0.0;  // as stamped, s from the start
  ClockReading clock;  // clock.t is the true time of reception
  AntennaInstant antenna;
  // The antenna at -2, -1, +1, +2 steps around the instant, for rates.
  std::array<AntennaInstant, 4> around;
  SunMoon bodies;
  PlaceNow place;
};

// The five-point rule uses values at -2, -1, +1, +2 steps; its error is far below 0.1 mm/s even for
// LEO.
inline constexpr double kRateStep_s = 0.05;
inline constexpr std::array<double, 4> kRateTimes = {-2.0 * kRateStep_s, -kRateStep_s, kRateStep_s,
                                                     2.0 * kRateStep_s};
inline double rate_of(const std::array<double, 4>& v) {
  return (8.0 * (v[2] - v[1]) - (v[3] - v[0])) / (12.0 * kRateStep_s);
}

}  // namespace leonav::sim
