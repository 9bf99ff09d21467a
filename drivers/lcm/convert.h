// Elements of decoded messages -> core structs, with every value judged: finite, in range, known.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <leonav/antenna_t.hpp>
#include <leonav/checkpoint_t.hpp>
#include <leonav/ephemeris_t.hpp>
#include <leonav/gnss_observation_t.hpp>
#include <leonav/precise_state_t.hpp>

#include "core/gnss/antenna_model.h"
#include "core/gnss/ephemeris.h"
#include "core/gnss/observation.h"
#include "core/gnss/satellite_catalog.h"
#include "core/navigator/checkpoint.h"
#include "core/navigator/outputs.h"
#include "drivers/lcm/wire.h"

namespace leonav::wire {

inline bool is_time(std::int64_t ns) { return ns > 0 && ns <= kMaxTimeNs; }
inline bool is_time_or_unset(std::int64_t ns) { return ns == 0 || is_time(ns); }

template <std::size_t N>
bool all_finite(const double (&values)[N]) {
  return std::all_of(values, values + N, [](double value) { return std::isfinite(value); });
}

// kNone: `to` is filled; otherwise what it holds means nothing.
InputFault convert(const gnss_observation_t& from, SignalObservation* to);
InputFault convert(const precise_state_t& from, GpsTime time, PreciseState* to);
InputFault convert(const ephemeris_t& from, Ephemeris* to);
InputFault convert(const antenna_t& from, AntennaPattern* to);
InputFault convert(const checkpoint_t& from, Checkpoint* to);

}  // namespace leonav::wire
