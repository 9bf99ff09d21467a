// InputMessages encodes inputs as one sender does: each channel counts its messages from 1.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"

namespace leonav {

// A message and the channel it belongs to. `bytes` are valid until the next one is encoded.
struct InputMessage {
  Channel channel = Channel::kImu;
  ByteSpan bytes;
};

// The importer, the simulator and leonav-connect encode through this class, so that the same values
// become the same bytes whichever of them sends them.
class InputMessages {
 public:
  InputMessage encode(const ImuSample& sample);
  InputMessage encode(const OdometerIncrement& increment);
  InputMessage encode(const RawEpoch& epoch);
  InputMessage encode(const Ephemeris& ephemeris);
  // `time` is when the message arrives at the vehicle; the other types carry a time of their own.
  InputMessage encode(const KlobucharModel& model, GpsTime time);
  InputMessage encode(const AntennaPattern& pattern, GpsTime time);
  // Precondition: as of Encoder::encode().
  InputMessage encode(std::span<const PreciseState> states);
  InputMessage encode(std::span<const CorrectedState> states, const CorrectionSource& source);
  InputMessage encode(std::span<const SignalBias> biases);

 private:
  std::uint64_t next_sequence(Channel channel) { return ++sequences_[index_of(channel)]; }

  Encoder encoder_;
  std::array<std::uint64_t, kChannelCount> sequences_{};
};

}  // namespace leonav
