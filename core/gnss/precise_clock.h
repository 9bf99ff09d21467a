// Interpolates tabulated precise clocks of one satellite.
#pragma once
#include <cstddef>

#include "core/gnss/satellite.h"
#include "core/time/gps_time.h"

namespace leonav {

struct ClockNode {
  GpsTime time;
  double clock_s = 0.0;    // s, without the periodic relativistic term; NaN: none
  bool event = false;      // the clock was changed since the node before, or at this one
  bool predicted = false;  // not from observations
};

struct PreciseClock {
  double clock_s = 0.0;
  double drift = 0.0;        // s/s
  double change_m2 = 0.0;    // variance of the interpolation, times c^2
  double constant_m2 = 0.0;  // variance of the product itself, likewise
  double nearest_s = 0.0;    // to the nearest of the two nodes
};

// Clock at `time`, linear between the two of `count` nodes (in order of time) around it; up to
// kClockExtrapolation of an interval before the first and after the last node too, as epochs and
// nodes coincide and the signal left before. False (and `*clock` unchanged) where these two are
// farther apart than `max_gap_s`, one has no clock, or the clock was changed between them.
bool interpolate_clock(const ClockNode* nodes, std::size_t count, GpsTime time, double max_gap_s,
                       System system, PreciseClock* clock);

// Whether nodes `i` and `i` + 1 differ by more than their neighbours' rates explain: a change of
// the clock that no flag tells, as clock files have none. Steps beyond kClockStep count.
bool is_unflagged_step(const ClockNode* nodes, std::size_t count, std::size_t i, double max_gap_s);

inline constexpr double kClockExtrapolation = 0.05;
inline constexpr double kClockStep = 1e-9;  // s; over 30 s a clock strays by 0.1e-9 s (1 sigma)

// The clock between `a` and `b` by the same rules but the last.
bool interpolate_between(const ClockNode& a, const ClockNode& b, GpsTime time, System system,
                         PreciseClock* clock);

}  // namespace leonav
