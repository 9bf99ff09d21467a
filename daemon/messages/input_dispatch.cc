#include "daemon/messages/input_dispatch.h"

#include <algorithm>

#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

// A sender that restarts, or a message that came twice, is no loss; neither is a hostile leap.
constexpr std::uint64_t kMaxBelievableLoss = 1'000'000;

}  // namespace

ByteSpan limit_length(ByteSpan bytes) {
  return bytes.first(std::min(bytes.size(), wire::kMaxMessageBytes + 1));
}

InputDispatch::InputDispatch(Sequencer* sequencer)
    : sequencer_(sequencer),
      epoch_(std::make_unique<RawEpoch>()),
      states_(std::make_unique<PreciseStates>()),
      corrected_(std::make_unique<CorrectedStates>()),
      biases_(std::make_unique<SignalBiases>()),
      antenna_(std::make_unique<AntennaPattern>()) {}

void InputDispatch::dispatch(Channel channel, ByteSpan bytes) {
  if (channel == Channel::kRefused) {
    if (const auto refused = decode_refused(bytes)) refuse(*refused);
    return;
  }
  const InputFault fault = decode(channel, bytes);
  if (fault == InputFault::kNone) return accept();
  ++counters_.received[index_of(channel)];
  sequencer_->on_rejected(fault);
}

InputFault InputDispatch::decode(Channel channel, ByteSpan bytes) {
  channel_ = channel;
  result_ = decode_input(channel, limit_length(bytes));
  return result_.fault;
}

void InputDispatch::accept() {
  ++counters_.received[index_of(channel_)];
  pass_on();
  count_lost_messages(channel_, result_.sequence);
  for (unsigned fault = 0; result_.element_faults >> fault != 0; ++fault) {
    if ((result_.element_faults >> fault & 1U) != 0) {
      sequencer_->on_rejected(static_cast<InputFault>(fault));
    }
  }
}

void InputDispatch::refuse(const RefusedInputs& refused) {
  counters_.received[index_of(refused.channel)] += refused.count;
  counters_.refused[index_of(refused.channel)] += refused.count;
  const auto fault = static_cast<std::size_t>(refused.fault);
  if (fault < kInputFaultCount)
    counters_.refused_by[index_of(refused.channel)][fault] += refused.count;
  sequencer_->on_refused(refused.fault, refused.count);
}

// Each value is made anew, so that nothing of a message that was refused is left in it.
DecodeResult InputDispatch::decode_input(Channel channel, ByteSpan bytes) {
  switch (channel) {
    case Channel::kImu:
      imu_ = ImuSample();
      return decoder_.decode(bytes, &imu_);
    case Channel::kGnssEpoch:
      return decoder_.decode(bytes, epoch_.get());
    case Channel::kOdometer:
      odometer_ = OdometerIncrement();
      return decoder_.decode(bytes, &odometer_);
    case Channel::kEphemeris:
      ephemeris_ = Ephemeris();
      return decoder_.decode(bytes, &ephemeris_);
    case Channel::kOrbitClock:
      return decoder_.decode(bytes, states_.get());
    case Channel::kCorrectedStates:
      return decoder_.decode(bytes, corrected_.get());
    case Channel::kBiases:
      return decoder_.decode(bytes, biases_.get());
    case Channel::kIonosphere:
      ionosphere_ = KlobucharModel();
      return decoder_.decode(bytes, &ionosphere_);
    case Channel::kAntenna:
      return decoder_.decode(bytes, antenna_.get());
    case Channel::kCommand:
      command_ = Command();
      return decoder_.decode(bytes, &command_);
    case Channel::kCheckpoint:
      checkpoint_ = Checkpoint();
      return decoder_.decode(bytes, &checkpoint_);
    default:
      return {};  // outputs are not ours to consume
  }
}

void InputDispatch::pass_on() {
  switch (channel_) {
    case Channel::kImu:
      return sequencer_->on_imu(imu_);
    case Channel::kGnssEpoch:
      return sequencer_->on_raw_epoch(*epoch_);
    case Channel::kOdometer:
      return sequencer_->on_odometer(odometer_);
    case Channel::kEphemeris:
      return sequencer_->on_ephemeris(ephemeris_);
    case Channel::kOrbitClock:
      return sequencer_->on_precise_states(*states_);
    case Channel::kCorrectedStates:
      return sequencer_->on_corrected_states(*corrected_);
    case Channel::kBiases:
      return sequencer_->on_signal_biases(*biases_);
    case Channel::kIonosphere:
      return sequencer_->on_klobuchar(ionosphere_);
    case Channel::kAntenna:
      return sequencer_->on_antenna(*antenna_);
    case Channel::kCommand:
      return sequencer_->on_command(command_);
    case Channel::kCheckpoint:
      return sequencer_->on_checkpoint(checkpoint_);
    default:
      return;
  }
}

void InputDispatch::count_lost_messages(Channel channel, std::uint64_t sequence) {
  std::uint64_t& last = last_sequence_[index_of(channel)];
  if (last != 0 && sequence > last + 1 && sequence - last <= kMaxBelievableLoss) {
    counters_.lost[index_of(channel)] += sequence - last - 1;
  }
  last = sequence;
}

}  // namespace leonav
