// This unit interpolates the tabulated precise clocks of one satellite.
#pragma once
#include <cstddef>

#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"

namespace leonav {

// One tabulated clock of a satellite.
struct ClockNode {
  GpsTime time;
  double clock_s = 0.0;    // s, without the periodic relativistic term; NaN: none
  bool event = false;      // the clock was changed since the node before, or at this one
  bool predicted = false;  // not from observations
};

// Returns the random walk (white frequency noise) of a satellite's clock, m/sqrt(s).
double clock_walk(System system);

// An interpolated clock with its variances.
struct PreciseClock {
  double clock_s = 0.0;
  double drift = 0.0;        // s/s
  double change_m2 = 0.0;    // variance of the interpolation, m^2
  double constant_m2 = 0.0;  // variance of the product itself, m^2
  double nearest_s = 0.0;    // time to the nearest of the two nodes
};

// Computes the clock at `time`, linear between the two of `count` nodes (in order of time) around
// it. `time` may lie up to kClockExtrapolation of an interval before the first or after the last
// node, because epochs and nodes coincide while the signal left before. Returns false (and leaves
// `*clock` unchanged) where these two nodes are farther apart than `max_gap_s`, one has no clock,
// or the clock was changed between them.
bool interpolate_clock(const ClockNode* nodes, std::size_t count, GpsTime time, double max_gap_s,
                       System system, PreciseClock* clock);

// Returns whether nodes `i` and `i` + 1 differ by more than their neighbours' rates explain: a
// change of the clock without a flag, as clock files have no flags. Only steps beyond kClockStep
// count.
bool is_unflagged_step(const ClockNode* nodes, std::size_t count, std::size_t i, double max_gap_s);

inline constexpr double kClockExtrapolation = 0.05;
// s; over 30 s the random walk of a clock is 0.1e-9 s (1 sigma)
inline constexpr double kClockStep = 1e-9;

// Computes the clock between `a` and `b` by the rules of interpolate_clock, but without the test of
// unflagged steps.
bool interpolate_between(const ClockNode& a, const ClockNode& b, GpsTime time, System system,
                         PreciseClock* clock);

}  // namespace leonav
