// This header defines what a receiver measured at one epoch, before any model is applied.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <limits>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// The measurements of one signal of one satellite. A value that was not measured is NaN.
struct SignalObservation {
  SatelliteId satellite;
  SignalCode code;
  double pseudorange_m = kNotMeasured;
  double carrier_cycles = kNotMeasured;
  double doppler_hz = kNotMeasured;  // RINEX sign: positive when the range shrinks
  double cn0_dbhz = kNotMeasured;
  // Continuous carrier tracking time, where the receiver gives it.
  double lock_time_s = kNotMeasured;
  bool loss_of_lock = false;  // carrier cycle count may have been interrupted since last epoch
  bool half_cycle_ambiguous = false;  // carrier may be off by half a cycle
};

// Returns whether `a` stands before `b` in a RawEpoch: by satellite, then by code.
inline bool comes_before(const SignalObservation& a, const SignalObservation& b) {
  return a.satellite != b.satellite ? a.satellite < b.satellite : a.code < b.code;
}

// All observations of one epoch, sorted by comes_before(); there is at most one per satellite
// and code.
struct RawEpoch {
  GpsTime time;  // receiver's time tag of signal reception
  boost::container::static_vector<SignalObservation, kMaxObservations> observations;
};

}  // namespace leonav
