// Each input is checked by itself here, before its time is compared with that of other inputs.
#pragma once
#include "core/navigator/interface/input_fault.h"
#include "core/navigator/interface/stage_work.h"

namespace leonav {

// Stamps outside 1980..2100 come from damaged messages; inside, differences cannot overflow.
bool is_plausible(GpsTime time);

struct ImuLimits {
  double rotation_rate = 0.0;   // rad/s, per axis
  double specific_force = 0.0;  // m/s^2, per axis
  std::int64_t interval_ns = 0;
};
InputFault check(const ImuSample& sample, const ImuLimits& limits);
// `speed`: largest wheel speed, m/s; `interval_ns`: longest interval.
InputFault check(const OdometerIncrement& increment, double speed, std::int64_t interval_ns);
InputFault check(const PreciseState& state);
// Checks measured values: kNotFinite for infinity, kNotSane for what no satellite signal can give
// (code 1e9 m, carrier 1e11 cycles, Doppler 1e6 Hz, C/N0 outside 0 to 100 dB-Hz).
InputFault check(const SignalObservation& observation);
InputFault check(const KlobucharModel& model);
InputFault check(const AntennaPattern& pattern);
InputFault check(const Command& command);
// Requires a position on the Earth, a heading within a turn, and sigmas in range.
InputFault check(const Checkpoint& checkpoint);

// Copies `from` without the observations that no receiver can have made (invalid satellite, same
// satellite and signal again), sorted as RawEpoch requires. Returns how many were left out.
std::size_t copy_valid_observations(const RawEpoch& from, RawEpoch* to);

}  // namespace leonav
