// Jumps of the receiver's clock by whole milliseconds, which come to all satellites at once.
#pragma once
#include <cstdint>
#include <span>

namespace leonav {

// What one satellite contributes. NaN: not known.
struct ClockJumpSample {
  double code_change_m = 0.0;     // of the pseudorange since the last epoch
  double carrier_change_m = 0.0;  // of the carrier
  double mean_rate_m_s = 0.0;     // from Doppler, mean of both epochs; positive: range grows
};

// Receivers that keep their clock within a millisecond of GPS time let it jump. Three customs:
// code jumps and carrier goes on; both jump; or the time tag jumps instead.
struct ClockJump {
  int code_ms = 0;            // by which all codes jumped
  int carrier_ms = 0;         // by which all carriers jumped
  int tag_ms = 0;             // by which the time tags' interval is too long
  bool unrepairable = false;  // all codes left their carriers by no whole millisecond

  bool any() const { return code_ms != 0 || carrier_ms != 0 || tag_ms != 0 || unrepairable; }
};

// `interval_s` between the time tags, `usual_interval_s` of the epochs before (0: not known). A
// jump is what at least two satellites and two thirds of them share. Nothing moves a range by
// 150 km in an interval of up to `kMaxJumpInterval_s`; longer ones are not examined.
inline constexpr double kMaxJumpInterval_s = 90.0;
ClockJump find_clock_jump(std::span<const ClockJumpSample> samples, double interval_s,
                          double usual_interval_s);

// The interval in which the ranges changed: the tags' interval without what jumped.
double true_interval_s(const ClockJump& jump, double interval_s);

}  // namespace leonav
