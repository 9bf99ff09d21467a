// LCM messages as bytes -> core structs. Every byte is taken to be hostile: a message is either
// wholly valid or refused with its fault, and nothing is allocated by what the wire claims.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "core/gnss/ephemeris.h"
#include "core/gnss/observation.h"
#include "core/gnss/satellite_catalog.h"
#include "core/ins/imu.h"
#include "core/navigator/outputs.h"
#include "core/navigator/stage_work.h"

namespace leonav {

using ByteSpan = std::span<const std::uint8_t>;

struct DecodeResult {
  InputFault fault = InputFault::kNone;  // kNone: the output is valid; otherwise leave it alone
  std::uint64_t sequence = 0;            // the sender's count; 0 when it could not be read
  // Faults of single observations or states, as bits 1 << InputFault. Those were left out, the
  // rest of the message is good.
  std::uint32_t element_faults = 0;
};

// Takes all its memory at construction. One thread at a time.
class Decoder {
 public:
  Decoder();
  ~Decoder();
  Decoder(Decoder&&) noexcept;
  Decoder& operator=(Decoder&&) noexcept;

  DecodeResult decode(ByteSpan bytes, ImuSample* sample);
  // Observations come out sorted; copies of one satellite and code are all dropped (kDuplicate), as
  // none can be trusted.
  DecodeResult decode(ByteSpan bytes, RawEpoch* epoch);
  DecodeResult decode(ByteSpan bytes, OdometerIncrement* increment);
  DecodeResult decode(ByteSpan bytes, Ephemeris* ephemeris);
  DecodeResult decode(ByteSpan bytes, KlobucharModel* model);
  DecodeResult decode(ByteSpan bytes, PreciseStates* states);
  DecodeResult decode(ByteSpan bytes, AntennaPattern* pattern);
  DecodeResult decode(ByteSpan bytes, Command* command);
  DecodeResult decode(ByteSpan bytes, Checkpoint* checkpoint);
  DecodeResult decode(ByteSpan bytes, Decision* decision);
  // Which epoch it is of, and the iterations that were made; nothing else is read.
  DecodeResult decode(ByteSpan bytes, SmootherReport* report);

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace leonav
