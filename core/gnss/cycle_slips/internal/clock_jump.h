// This unit finds jumps of the receiver's clock by whole milliseconds, which affect all satellites
// at once.
#pragma once
#include <cstdint>
#include <span>

#include "core/gnss/signals/signal.h"

namespace leonav {

// Changes of one satellite's measurements since the last epoch. NaN: unknown.
struct ClockJumpSample {
  double code_change_m = 0.0;     // of the pseudorange
  double carrier_change_m = 0.0;  // of the carrier
  double mean_rate_m_s = 0.0;     // from Doppler, mean of both epochs; positive: range grows
};

// Receivers that keep their clock within a millisecond of GPS time let it jump, in one of three
// ways: the code jumps and the carrier goes on; both jump; or the time tag jumps instead.
struct ClockJump {
  int code_ms = 0;            // by which all codes jumped
  int carrier_ms = 0;         // by which all carriers jumped
  int tag_ms = 0;             // by which the time tags' interval is too long
  bool unrepairable = false;  // all codes left their carriers, but by no whole millisecond

  bool any() const { return code_ms != 0 || carrier_ms != 0 || tag_ms != 0 || unrepairable; }
};

// Finds the jump that at least two satellites and two thirds of them share. `interval_s` is between
// the time tags, `nominal_interval_s` that of the epochs before (0: unknown). Nothing moves a range
// by 150 km in an interval of up to `kMaxJumpInterval_s`; longer intervals are not examined.
// What the clock of a receiver jumps by, as a range.
inline constexpr double kMillisecond_m = 1.0e-3 * kSpeedOfLight;
inline constexpr double kMaxJumpInterval_s = 90.0;
ClockJump find_clock_jump(std::span<const ClockJumpSample> samples, double interval_s,
                          double nominal_interval_s);

// Returns the interval in which the ranges changed: the interval of the tags without the jump.
double true_interval_s(const ClockJump& jump, double interval_s);

}  // namespace leonav
