// This unit turns multiple signal messages into observations and keeps the lock state of every
// signal. Source: RTCM 10403.3, 3.5.16.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/gnss/signals/observation.h"
#include "drivers/rtcm3/msm_lock_time.h"
#include "drivers/rtcm3/msm_message.h"

namespace leonav {

// Counts of measurements, which are signals of a satellite at an epoch.
struct MsmMeasurementCounters {
  std::uint64_t measurements = 0;    // of messages, before the capacity of an epoch
  std::uint64_t unknown_signal = 0;  // bit of the signal mask without a RINEX code
  std::uint64_t bad_satellite = 0;   // number outside its system's range
  std::uint64_t bad_value = 0;       // single values out of range (left out)
  std::uint64_t duplicates = 0;      // same satellite and code twice in an epoch
  std::uint64_t empty = 0;           // neither code nor carrier nor Doppler
};

// One receiver's observations.
class MsmObservations {
 public:
  // Adds the message's measurements at `time` to those of the epoch, in the order of the message.
  // Of a satellite and code that come twice at one time, the first is used.
  //
  // Code and carrier are (rough + fine) 299792.458 m/ms, the carrier divided by the wavelength, and
  // the Doppler is minus (rough + fine rate) over the wavelength: a growing range is a falling
  // frequency.
  void add(const MsmMessage& message, GpsTime time, std::vector<SignalObservation>* signals);
  // The next carrier of each signal continues none: it is another receiver's.
  void interrupt_carriers();
  const MsmMeasurementCounters& counters() const { return counters_; }

 private:
  struct SignalState {
    GpsTime seen;  // last epoch with this signal, with or without a carrier
    MsmLock lock;
  };
  static constexpr std::size_t kSatellites = 64;  // numbers within a system

  bool decode(const MsmMessage& message, const MsmCell& cell, GpsTime time,
              SignalObservation* observation);
  double checked(double value, double low, double high);
  SignalState& state_of(SatelliteId satellite, std::size_t signal);

  MsmMeasurementCounters counters_;
  // Of each satellite's signals, by their number in the message, once they have come.
  std::map<std::pair<SatelliteId, std::size_t>, SignalState> states_;
  MsmLock first_lock_;  // of signals that have not come
};

}  // namespace leonav
