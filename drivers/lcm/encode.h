// The Encoder converts core structs to LCM messages.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/signals/observation.h"
#include "core/inertial/strapdown/imu.h"
#include "core/navigator/interface/decision.h"
#include "core/navigator/interface/epoch_report.h"
#include "core/navigator/interface/event.h"
#include "core/navigator/interface/smoother_report.h"
#include "core/navigator/interface/solution.h"
#include "core/navigator/interface/stage_work.h"

namespace leonav {

using ByteSpan = std::span<const std::uint8_t>;

// The returned span points into the encoder's own buffer and is valid until the next call. All
// memory is taken at construction. One thread at a time. Satellite names and enums are written as
// they are: values that the Decoder would refuse must not be encoded.
class Encoder {
 public:
  Encoder();
  ~Encoder();
  Encoder(Encoder&&) noexcept;
  Encoder& operator=(Encoder&&) noexcept;

  // Inputs. `sequence` counts the messages of a channel from 1.
  ByteSpan encode(const ImuSample& sample, std::uint64_t sequence);
  ByteSpan encode(const RawEpoch& epoch, std::uint64_t sequence);
  ByteSpan encode(const OdometerIncrement& increment, std::uint64_t sequence);
  ByteSpan encode(const Ephemeris& ephemeris, std::uint64_t sequence);
  // All states have one time; the first gives the time on the wire. At most
  // kMaxEphemerisSatellites.
  ByteSpan encode(std::span<const PreciseState> states, std::uint64_t sequence);
  ByteSpan encode(const KlobucharModel& model, GpsTime time, std::uint64_t sequence);
  ByteSpan encode(const AntennaPattern& pattern, GpsTime time, std::uint64_t sequence);
  ByteSpan encode(const Command& command, GpsTime time, std::uint64_t sequence);
  ByteSpan encode(const Checkpoint& checkpoint, std::uint64_t sequence);

  // Outputs.
  ByteSpan encode(const Solution& solution);
  ByteSpan encode(const EpochReport& report);
  ByteSpan encode_constraints(const EpochReport& report);
  ByteSpan encode(const Event& event);
  ByteSpan encode(const Decision& decision);
  ByteSpan encode(const SmootherReport& report);

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace leonav
