// What a receiver measured at one epoch, before any model has touched it.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <limits>

#include "core/capacity.h"
#include "core/gnss/satellite.h"
#include "core/gnss/signal.h"
#include "core/time/gps_time.h"

namespace leonav {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// One signal of one satellite. A value that was not measured is NaN.
struct SignalObservation {
  SatelliteId satellite;
  SignalCode code;
  double pseudorange_m = kNotMeasured;
  double carrier_cycles = kNotMeasured;
  double doppler_hz = kNotMeasured;  // RINEX sign: positive when the range shrinks
  double cn0_dbhz = kNotMeasured;
  double lock_time_s = kNotMeasured;  // continuous carrier tracking time, where the receiver tells
  bool loss_of_lock = false;  // carrier cycle count may have been interrupted since last epoch
  bool half_cycle_ambiguous = false;  // carrier may be off by half a cycle
};

// Observations are sorted by satellite, then code; at most one per satellite and code.
struct RawEpoch {
  GpsTime time;  // receiver's time tag of signal reception
  boost::container::static_vector<SignalObservation, kMaxObservations> observations;
};

}  // namespace leonav
