// The InputDispatch decodes a message and passes the input to the Sequencer, in daemon and replay.
#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "core/navigator/sequencer/sequencer.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/decode.h"

namespace leonav {

class InputDispatch {
 public:
  explicit InputDispatch(Sequencer* sequencer);

  // Decodes and passes on. A bad message is reported to the Sequencer, once per kind of fault in
  // it. `channel` must be an input.
  void dispatch(Channel channel, ByteSpan bytes);

  struct Counters {
    std::array<std::uint64_t, kInputChannels.size()> received{};  // by channel, bad ones too
    // Numbers missing from the senders' sequences: messages lost on the way.
    std::array<std::uint64_t, kInputChannels.size()> lost{};
  };
  const Counters& counters() const { return counters_; }

 private:
  void decode(Channel channel, ByteSpan bytes, DecodeResult* result);
  void count_lost_messages(Channel channel, std::uint64_t sequence);

  Sequencer* sequencer_;
  Decoder decoder_;
  std::unique_ptr<RawEpoch> epoch_;        // too large for a stack
  std::unique_ptr<PreciseStates> states_;  // too large as well
  std::unique_ptr<CorrectedStates> corrected_;
  std::unique_ptr<SignalBiases> biases_;
  std::unique_ptr<AntennaPattern> antenna_;
  Counters counters_;
  std::array<std::uint64_t, kInputChannels.size()> last_sequence_{};
};

// Cuts a message to one byte more than the longest valid one, so that a longer one is refused as
// too long and the journal need not hold all of it.
ByteSpan limit_length(ByteSpan bytes);

}  // namespace leonav
