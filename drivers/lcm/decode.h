// Decoder converts LCM messages to core's values and treats every byte as hostile.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/signals/observation.h"
#include "core/inertial/strapdown/imu.h"
#include "core/navigator/interface/decision.h"
#include "core/navigator/interface/input_fault.h"
#include "core/navigator/interface/smoother_report.h"
#include "core/navigator/interface/stage_work.h"

namespace leonav {

using ByteSpan = std::span<const std::uint8_t>;

// The result of decoding one message.
struct DecodeResult {
  InputFault fault = InputFault::kNone;  // kNone: the output is valid; otherwise do not use it
  std::uint64_t sequence = 0;            // the sender's count; 0 if it could not be read
  // Faults of single observations or states, as bits 1 << InputFault. These were excluded; the rest
  // of the message is valid.
  std::uint32_t element_faults = 0;
};

// Decoder accepts a message as a whole or refuses it with its fault. No count in a message makes it
// allocate: all memory is taken at construction. Only one thread may use it at a time.
class Decoder {
 public:
  Decoder();
  ~Decoder();
  Decoder(Decoder&&) noexcept;
  Decoder& operator=(Decoder&&) noexcept;

  // Every decode() fills its output if the fault is kNone.
  DecodeResult decode(ByteSpan bytes, ImuSample* sample);
  // Observations are sorted. Several observations of one satellite and signal are all dropped
  // (kDuplicate), because none can be trusted.
  DecodeResult decode(ByteSpan bytes, RawEpoch* epoch);
  DecodeResult decode(ByteSpan bytes, OdometerIncrement* increment);
  DecodeResult decode(ByteSpan bytes, Ephemeris* ephemeris);
  DecodeResult decode(ByteSpan bytes, KlobucharModel* model);
  DecodeResult decode(ByteSpan bytes, PreciseStates* states);
  DecodeResult decode(ByteSpan bytes, CorrectedStates* states);
  DecodeResult decode(ByteSpan bytes, SignalBiases* biases);
  DecodeResult decode(ByteSpan bytes, AntennaPattern* pattern);
  DecodeResult decode(ByteSpan bytes, Command* command);
  DecodeResult decode(ByteSpan bytes, Checkpoint* checkpoint);
  DecodeResult decode(ByteSpan bytes, Decision* decision);
  // Only the epoch and the number of iterations are read.
  DecodeResult decode(ByteSpan bytes, SmootherReport* report);

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace leonav
