// The InputDispatch decodes a message and passes the input to the Sequencer, in daemon and replay.
#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "core/navigator/sequencer/sequencer.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/decode.h"
#include "drivers/lcm/journal_marks.h"

namespace leonav {

class InputDispatch {
 public:
  explicit InputDispatch(Sequencer* sequencer);

  // Decodes and passes on. A bad message is reported to the Sequencer, once per kind of fault in
  // it. `channel`: is_replayed(). For logs, of which the older ones hold what was refused.
  void dispatch(Channel channel, ByteSpan bytes);

  // The same in two steps, for who must know in between whether the message is refused: accept() is
  // to be called where decode() returns kNone, before the next decode(). `channel` must be an
  // input.
  InputFault decode(Channel channel, ByteSpan bytes);
  void accept();
  // What the last message that decode() took held, where it was of that kind.
  const Ephemeris& ephemeris() const { return ephemeris_; }
  const KlobucharModel& ionosphere() const { return ionosphere_; }
  const SignalBiases& biases() const { return *biases_; }

  // Counts messages that were refused by decode(), now or when a journal was written.
  void refuse(const RefusedInputs& refused);

  struct Counters {
    std::array<std::uint64_t, kInputChannels.size()> received{};  // by channel, bad ones too
    // Of these, those that refuse() counted, in all and by fault.
    std::array<std::uint64_t, kInputChannels.size()> refused{};
    std::array<std::array<std::uint64_t, kInputFaultCount>, kInputChannels.size()> refused_by{};
    // Numbers missing from the senders' sequences: messages lost on the way.
    std::array<std::uint64_t, kInputChannels.size()> lost{};
  };
  const Counters& counters() const { return counters_; }

 private:
  DecodeResult decode_input(Channel channel, ByteSpan bytes);
  void pass_on();
  void count_lost_messages(Channel channel, std::uint64_t sequence);

  Sequencer* sequencer_;
  Decoder decoder_;
  // What decode() has made of the last message.
  Channel channel_ = Channel::kImu;
  DecodeResult result_;
  ImuSample imu_;
  OdometerIncrement odometer_;
  Ephemeris ephemeris_;
  KlobucharModel ionosphere_;
  Command command_;
  Checkpoint checkpoint_;
  std::unique_ptr<RawEpoch> epoch_;        // too large for a stack
  std::unique_ptr<PreciseStates> states_;  // too large as well
  std::unique_ptr<CorrectedStates> corrected_;
  std::unique_ptr<SignalBiases> biases_;
  std::unique_ptr<AntennaPattern> antenna_;
  Counters counters_;
  std::array<std::uint64_t, kInputChannels.size()> last_sequence_{};
};

// Cuts a message to one byte more than the longest valid one, so that a longer one is refused as
// too long and the journal need not hold the whole message.
ByteSpan limit_length(ByteSpan bytes);

}  // namespace leonav
