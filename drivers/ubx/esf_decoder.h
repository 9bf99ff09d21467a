// This unit decodes UBX-ESF-MEAS (0x10 0x02) and UBX-ESF-RAW (0x10 0x03), the measurements of the
// inertial sensor of a receiver such as NEO-M8U or ZED-F9R.
//
// Source: u-blox ZED-F9R interface description UBX-22010984, sections of these names and "ESF
// measurement data".
#pragma once
#include <cstdint>
#include <functional>
#include <span>

#include "drivers/binary/wrapped_counter.h"
#include "drivers/ubx/esf_reading.h"

namespace leonav {

// Counts of messages.
struct EsfCounters {
  std::uint64_t readings = 0;      // samples of all six axes
  std::uint64_t bad_length = 0;    // a message that does not hold what it claims
  std::uint64_t other_values = 0;  // of odometers and of types that are not known
  std::uint64_t incomplete = 0;    // samples whose other axes did not come
  std::uint64_t superseded = 0;    // UBX-ESF-MEAS beside UBX-ESF-RAW: left out
};

// UBX-ESF-MEAS holds some axes at one time; the rates and the forces of one time come in two
// messages. Its clock is the receiver's own in milliseconds: calibTtag where it is there, timeTag
// otherwise. UBX-ESF-RAW holds several whole samples with the time tags of the sensor, of which 24
// bits count in steps of 39.0625 us. That step is in no document of the receiver; it is the one of
// the sensors that it contains, and whoever uses the clock finds its drift. Where both
// messages come, UBX-ESF-RAW is used: it is finer and has every sample.
class EsfDecoder {
 public:
  using Take = std::function<void(const EsfReading&)>;

  EsfDecoder();
  void decode_meas(std::span<const std::uint8_t> payload, const Take& take);
  void decode_raw(std::span<const std::uint8_t> payload, const Take& take);
  EsfCounters counters() const;

 private:
  void add(EsfAssembly* assembly, const EsfValue& value, std::int64_t clock_ns, const Take& take);

  WrappedCounter milliseconds_{32}, ticks_{24};
  EsfAssembly meas_, raw_;
  bool has_raw_ = false;
  EsfCounters counters_;
};

}  // namespace leonav
