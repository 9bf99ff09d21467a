// This unit makes a RawEpoch of the measurements of one message.
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/gnss/signals/observation.h"
#include "drivers/binary/range_measurement.h"
#include "drivers/epoch/epoch_capacity.h"

namespace leonav {

// Counts of epochs and measurements.
struct RangeEpochCounters {
  std::uint64_t epochs = 0;
  std::uint64_t repeated = 0;        // messages with the time of the epoch before
  std::uint64_t measurements = 0;    // put into epochs
  std::uint64_t other_system = 0;    // GLONASS, SBAS, QZSS, NavIC, L-band
  std::uint64_t unknown_signal = 0;  // signal without a RINEX code
  std::uint64_t bad_satellite = 0;   // number outside its system's range
  std::uint64_t bad_value = 0;       // single values not finite or out of range (left out)
  std::uint64_t duplicates = 0;      // same satellite and code twice in an epoch
  std::uint64_t empty = 0;           // neither code nor carrier nor Doppler
};

// The lock state of each signal is kept from epoch to epoch, so that a carrier whose lock has
// begun anew gets loss_of_lock.
class RangeEpochs {
 public:
  // Fills `epoch`, sorted; returns false for a message of the time of the epoch before, as where
  // NovAtel's RANGE and RANGECMP are both logged.
  bool assemble(GpsTime time, std::span<const RangeMeasurement> measurements, RawEpoch* epoch);
  const RangeEpochCounters& counters() const { return counters_; }
  const CapacityLosses& losses() const { return capacity_.losses(); }

 private:
  struct Lock {
    GpsTime time;  // of the last epoch that had this signal's carrier
    double lock_time_s = 0.0;
    bool half_cycle_is_added = false;
  };

  bool take(GpsTime time, const RangeMeasurement& measurement, SignalObservation* observation);
  double checked(double value, double low, double high);
  bool lock_was_lost(GpsTime time, const RangeMeasurement& now, const Lock& last) const;
  void sort_and_drop_duplicates();

  RangeEpochCounters counters_;
  GpsTime last_time_;
  std::vector<SignalObservation> signals_;  // of the epoch
  EpochCapacity capacity_;
  std::map<std::pair<SatelliteId, SignalCode>, Lock> locks_;
};

}  // namespace leonav
