// These functions check each input by itself, before its time is compared with that of other
// inputs.
#pragma once
#include "core/navigator/interface/input_fault.h"
#include "core/navigator/interface/stage_work.h"

namespace leonav {

// Returns whether a stamp lies between 1980 and 2100. Others come from damaged messages; within
// this range differences of stamps cannot overflow.
bool is_plausible(GpsTime time);

// Largest values of an IMU sample.
struct ImuLimits {
  double rotation_rate = 0.0;   // rad/s, per axis
  double specific_force = 0.0;  // m/s^2, per axis
  std::int64_t interval_ns = 0;
};

// Every check() returns the fault of an input, or kNone.
InputFault check(const ImuSample& sample, const ImuLimits& limits);
// `speed` is the largest wheel speed, m/s; `interval_ns` the longest interval.
InputFault check(const OdometerIncrement& increment, double speed, std::int64_t interval_ns);
InputFault check(const PreciseState& state);
InputFault check(const CorrectedState& state);
InputFault check(const SignalBias& bias);
// Checks measured values. Returns kNotFinite for infinity, and kNotSane for values that no
// satellite signal can give: a code of 1e9 m, a carrier of 1e11 cycles, a Doppler of 1e6 Hz, a C/N0
// outside 0 to 100 dB-Hz. NaN passes, because it means "not measured".
InputFault check(const SignalObservation& observation);
InputFault check(const KlobucharModel& model);
InputFault check(const AntennaPattern& pattern);
InputFault check(const Command& command);
InputFault check(const Calibration& calibration);
// Requires a position near the Earth's surface, a heading within a full turn, sigmas in range, and
// a calibration that passes, if there is one.
InputFault check(const Checkpoint& checkpoint);

// Copies `from` without the observations that no receiver can have made (invalid satellite or
// signal, or both the same as of another observation), sorted as RawEpoch requires. Returns how
// many were excluded.
std::size_t copy_valid_observations(const RawEpoch& from, RawEpoch* to);

}  // namespace leonav
