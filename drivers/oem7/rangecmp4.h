// This unit reads RANGECMP4 (2050). Source: OEM7 manual, RANGECMP4 and "Example of Bit Parsing a
// RANGECMP4 Log".
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "core/base/gps_time.h"
#include "drivers/binary/range_measurement.h"
#include "drivers/oem7/low_bit_reader.h"

namespace leonav {

// At a whole second a satellite is given by itself, as a reference; between seconds it may be given
// by what differs from the reference of that second, which is therefore kept.
class RangecmpFour {
 public:
  // Replaces `measurements` by those of a log's payload, all systems in its order. `time` is that
  // of the log's header.
  RangeStatus read(std::span<const std::uint8_t> payload, GpsTime time,
                   std::vector<RangeMeasurement>* measurements);
  // Signals whose reference was not received.
  std::uint64_t without_reference() const { return without_reference_; }

 private:
  static constexpr std::size_t kSatellites = 64, kSignals = 16;

  // One signal in metres and m/s; NaN where the log marks a value as not valid.
  struct Signal {
    double range_m = kNotMeasured;
    double carrier_m = kNotMeasured;
    double rate_m_s = kNotMeasured;  // positive when the range grows
  };
  struct Reference {
    GpsTime time;  // unset: none
    std::uint32_t block = 0;
    Signal signal;
  };
  // The satellite whose signals are being read.
  struct Satellite {
    std::uint32_t system = 0, number = 0;  // the log's
    bool is_differential = false;
    std::uint32_t block = 0;  // number of the reference
    bool is_first_signal = true;
    Signal primary;  // of a reference: the first signal
  };

  void read_system(std::uint32_t system, GpsTime time, LowBitReader* bits,
                   std::vector<RangeMeasurement>* measurements);
  RangeMeasurement read_signal(std::uint32_t signal, GpsTime time, Satellite* satellite,
                               LowBitReader* bits);
  static Signal read_reference(const Satellite& satellite, LowBitReader* bits);
  Signal read_difference(const Satellite& satellite, std::uint32_t signal, GpsTime time,
                         LowBitReader* bits);

  // By system, and number and signal of the log.
  using Key = std::tuple<System, std::uint32_t, std::uint32_t>;
  std::map<Key, Reference> references_;
  std::uint64_t without_reference_ = 0;
};

}  // namespace leonav
