// This unit decodes UBX-RXM-RAWX (0x02 0x15), multi-GNSS raw measurements, to a RawEpoch. Source:
// u-blox ZED-F9P interface description UBX-22008968, section 3.17.5.
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "core/gnss/signals/observation.h"

namespace leonav {

// Settings of the decoder.
struct RxmRawxOptions {
  // Carriers whose standard deviation index (0.004 cycles each) is above this are excluded; 15
  // means "invalid".
  int max_carrier_std_index = 14;
};

// Outcome of one message.
enum class RxmRawxStatus : std::uint8_t {
  kOk = 0,
  kBadLength,   // payload does not hold the measurements it claims
  kBadVersion,  // version byte is not 1: the layout is unknown
  kBadTime,     // week or time of week not finite or out of range
};

// Counts of messages and measurements.
struct RxmRawxCounters {
  std::uint64_t epochs = 0;
  std::uint64_t bad_length = 0;
  std::uint64_t bad_version = 0;
  std::uint64_t bad_time = 0;
  std::uint64_t measurements = 0;    // put into epochs
  std::uint64_t other_system = 0;    // SBAS, QZSS, GLONASS, IMES, NavIC
  std::uint64_t unknown_signal = 0;  // signal identifier without a RINEX code
  std::uint64_t bad_satellite = 0;   // number outside its system's range
  std::uint64_t bad_value = 0;       // single values not finite or out of range (left out)
  std::uint64_t duplicates = 0;      // same satellite and code twice in an epoch
  std::uint64_t empty = 0;           // neither code nor carrier nor Doppler
};

// The decoder keeps the lock state of each signal from epoch to epoch, so that a carrier whose lock
// time has restarted gets loss_of_lock.
class RxmRawxDecoder {
 public:
  explicit RxmRawxDecoder(const RxmRawxOptions& options = {});
  RxmRawxStatus decode(std::span<const std::uint8_t> payload, RawEpoch* epoch);
  const RxmRawxCounters& counters() const { return counters_; }

 private:
  struct LockState {
    GpsTime time;  // last epoch that had this signal's carrier
    std::uint16_t lock_time_ms = 0;
    bool half_cycle_subtracted = false;
    bool suspect = false;  // since then the carrier was tracked without a standard deviation
  };
  static constexpr std::size_t kSatellites = 64;  // numbers within a system
  static constexpr std::size_t kSignalIds = 16;

  bool decode_measurement(const std::uint8_t* bytes, GpsTime time, SignalObservation* observation);
  void sort_and_drop_duplicates(RawEpoch* epoch);
  static bool lock_was_lost(const LockState& last, const LockState& now);

  RxmRawxOptions options_;
  RxmRawxCounters counters_;
  // Of each satellite's signals, by the receiver's number, once they have come.
  std::map<std::pair<SatelliteId, std::uint8_t>, LockState> lock_;
};

}  // namespace leonav
