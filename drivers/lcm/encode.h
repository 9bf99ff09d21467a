// Encoder converts core's values to LCM messages.
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
#include "drivers/lcm/output_schema.h"

namespace leonav {

using ByteSpan = std::span<const std::uint8_t>;

// Encoder returns a span into its own buffer, valid until the next call. All memory is taken at
// construction. Only one thread may use it at a time. Satellite names and enumerations are written
// unchecked: do not encode values that the Decoder would refuse.
class Encoder {
 public:
  // What there is room for from the beginning; the memory of other messages is taken when the first
  // is encoded.
  enum class Room : std::uint8_t { kInputsAndOutputs, kOutputs };

  // `schema`: the version of the outputs SOLUTION, EPOCH and SMOOTHER.
  explicit Encoder(OutputSchema schema = OutputSchema::kNewest,
                   Room room = Room::kInputsAndOutputs);
  ~Encoder();
  Encoder(Encoder&&) noexcept;
  Encoder& operator=(Encoder&&) noexcept;

  // These encode inputs. `sequence` counts the messages of a channel from 1.
  ByteSpan encode(const ImuSample& sample, std::uint64_t sequence);
  ByteSpan encode(const RawEpoch& epoch, std::uint64_t sequence);
  ByteSpan encode(const OdometerIncrement& increment, std::uint64_t sequence);
  ByteSpan encode(const Ephemeris& ephemeris, std::uint64_t sequence);
  // Precondition: all states have the same time, and there are at most kMaxEphemerisSatellites. The
  // time of the first is written.
  ByteSpan encode(std::span<const PreciseState> states, std::uint64_t sequence);
  // Precondition: the same, with kMaxCorrectedStates and kMaxBiases.
  ByteSpan encode(std::span<const CorrectedState> states, const CorrectionSource& source,
                  std::uint64_t sequence);
  ByteSpan encode(std::span<const SignalBias> biases, std::uint64_t sequence);
  ByteSpan encode(const KlobucharModel& model, GpsTime time, std::uint64_t sequence);
  ByteSpan encode(const AntennaPattern& pattern, GpsTime time, std::uint64_t sequence);
  ByteSpan encode(const Command& command, GpsTime time, std::uint64_t sequence);
  ByteSpan encode(const Checkpoint& checkpoint, std::uint64_t sequence);

  // These encode outputs, which carry their own sequence. encode_constraints() writes the
  // constraint reports, which encode() omits.
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
