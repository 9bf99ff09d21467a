// These functions convert elements of decoded messages to core's values and check every value.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <leonav/antenna_t.hpp>
#include <leonav/bias_t.hpp>
#include <leonav/checkpoint_t.hpp>
#include <leonav/checkpoint_v1_t.hpp>
#include <leonav/checkpoint_v2_t.hpp>
#include <leonav/corrected_state_t.hpp>
#include <leonav/ephemeris_t.hpp>
#include <leonav/gnss_observation_t.hpp>
#include <leonav/leo_ephemeris_t.hpp>
#include <leonav/precise_state_t.hpp>

#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/propagation/antenna_model.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "core/gnss/signals/observation.h"
#include "core/navigator/interface/checkpoint.h"
#include "core/navigator/interface/input_fault.h"
#include "drivers/lcm/wire.h"

namespace leonav::wire {

// Returns whether `ns` is a plausible GPS time in nanoseconds.
inline bool is_time(std::int64_t ns) { return ns > 0 && ns <= kMaxTimeNs; }
inline bool is_time_or_unset(std::int64_t ns) { return ns == 0 || is_time(ns); }

template <std::size_t N>
bool all_finite(const double (&values)[N]) {
  return std::all_of(values, values + N, [](double value) { return std::isfinite(value); });
}

// Every convert() requires values that are finite, in range and known. It returns kNone if `to` is
// filled; otherwise the content of `to` is undefined.
InputFault convert(const gnss_observation_t& from, SignalObservation* to);
InputFault convert(const precise_state_t& from, GpsTime time, PreciseState* to);
InputFault convert(const corrected_state_t& from, GpsTime time, CorrectedState* to);
InputFault convert(const bias_t& from, GpsTime time, SignalBias* to);
InputFault convert(const ephemeris_t& from, Ephemeris* to);
InputFault convert(const leo_ephemeris_t& from, Ephemeris* to);
InputFault convert(const antenna_t& from, AntennaPattern* to);
InputFault convert(const checkpoint_t& from, Checkpoint* to);
InputFault convert(const checkpoint_v1_t& from, Checkpoint* to);
InputFault convert(const checkpoint_v2_t& from, Checkpoint* to);

}  // namespace leonav::wire
