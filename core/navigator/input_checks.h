// What an input must satisfy by itself, before its place in time is looked at.
#pragma once
#include "core/navigator/outputs.h"
#include "core/navigator/stage_work.h"

namespace leonav {

// Stamps outside 1980..2100 come from damaged messages; inside, differences cannot overflow.
bool is_plausible(GpsTime time);

struct ImuLimits {
  double rotation_rate = 0.0;   // rad/s, per axis
  double specific_force = 0.0;  // m/s^2, per axis
  std::int64_t interval_ns = 0;
};
InputFault check(const ImuSample& sample, const ImuLimits& limits);
// `speed`: m/s, of a wheel.
InputFault check(const OdometerIncrement& increment, double speed, std::int64_t interval_ns);
InputFault check(const PreciseState& state);
// Of what was measured: kNotFinite for infinity, kNotSane for what no signal from a satellite gives
// (code 1e9 m, carrier 1e11 cycles, Doppler 1e6 Hz, C/N0 outside 0 to 100 dB-Hz).
InputFault check(const SignalObservation& observation);
InputFault check(const KlobucharModel& model);
InputFault check(const AntennaPattern& pattern);
InputFault check(const Command& command);
// Of a place on the Earth, a heading within a turn, sigmas that can be of them.
InputFault check(const Checkpoint& checkpoint);

// Copies `from`, without the observations no receiver can have made (invalid satellite, same
// satellite and signal again), sorted as RawEpoch promises. Returns how many were left out.
std::size_t copy_sane(const RawEpoch& from, RawEpoch* to);

}  // namespace leonav
