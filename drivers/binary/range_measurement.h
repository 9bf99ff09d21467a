// This header defines what a message with measurements says of one signal, whatever its format.
#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "core/gnss/signals/observation.h"

namespace leonav {

// Signs are RINEX's: the carrier grows with the range, the Doppler is positive when it shrinks.
struct RangeMeasurement {
  std::optional<System> system;    // nullopt: not used
  std::uint32_t number = 0;        // of the satellite in its system
  std::optional<SignalCode> code;  // nullopt: the signal has no RINEX code
  double pseudorange_m = kNotMeasured;
  double carrier_cycles = kNotMeasured;
  double doppler_hz = kNotMeasured;
  double cn0_dbhz = kNotMeasured;
  double lock_time_s = 0.0;
  // The message counts no further: a lock may be older.
  double lock_ceiling_s = std::numeric_limits<double>::infinity();
  bool lock_is_least = false;  // lock_time_s is a lower bound, of RANGECMP4
  double lock_unit_s = 0.0;  // lock_time_s counts whole units of so much, 0: finer than it matters
  bool parity_is_known = false;
  bool half_cycle_is_added = false;
};

// What became of one message.
enum class RangeStatus : std::uint8_t {
  kOk = 0,
  kBadLength,  // does not hold what it claims
};

}  // namespace leonav
