// From a message on a channel to the Sequencer: the one way in, for the daemon and for replay.
#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "core/navigator/sequencer.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/decode.h"

namespace leonav {

class InputDispatch {
 public:
  explicit InputDispatch(Sequencer* sequencer);

  // Decodes and hands on. A bad message is reported to the Sequencer, once per kind of fault in it.
  // `channel` must be an input.
  void dispatch(Channel channel, ByteSpan bytes);

  struct Counters {
    std::array<std::uint64_t, kInputChannels.size()> received{};  // by channel, bad ones too
    // Messages missing from the senders' counts: lost on the way here.
    std::array<std::uint64_t, kInputChannels.size()> lost{};
  };
  const Counters& counters() const { return counters_; }

 private:
  void decode(Channel channel, ByteSpan bytes, DecodeResult* result);
  void watch_sequence(Channel channel, std::uint64_t sequence);

  Sequencer* sequencer_;
  Decoder decoder_;
  std::unique_ptr<RawEpoch> epoch_;        // too large for a stack
  std::unique_ptr<PreciseStates> states_;  // likewise
  std::unique_ptr<AntennaPattern> antenna_;
  Counters counters_;
  std::array<std::uint64_t, kInputChannels.size()> last_sequence_{};
};

// What a message is cut to before anything looks at it: one byte more than the longest good one, so
// that it is refused as too long and the journal need not hold all of it.
ByteSpan limit_length(ByteSpan bytes);

}  // namespace leonav
