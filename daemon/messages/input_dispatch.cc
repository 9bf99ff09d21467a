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
  ++counters_.received[index_of(channel)];
  DecodeResult result;
  decode(channel, limit_length(bytes), &result);
  if (result.fault != InputFault::kNone) {
    sequencer_->on_rejected(result.fault);
    return;
  }
  count_lost_messages(channel, result.sequence);
  for (unsigned fault = 0; result.element_faults >> fault != 0; ++fault) {
    if ((result.element_faults >> fault & 1U) != 0) {
      sequencer_->on_rejected(static_cast<InputFault>(fault));
    }
  }
}

void InputDispatch::decode(Channel channel, ByteSpan bytes, DecodeResult* result) {
  const auto good = [result] { return result->fault == InputFault::kNone; };
  switch (channel) {
    case Channel::kImu: {
      ImuSample sample;
      *result = decoder_.decode(bytes, &sample);
      if (good()) sequencer_->on_imu(sample);
      break;
    }
    case Channel::kGnssEpoch:
      *result = decoder_.decode(bytes, epoch_.get());
      if (good()) sequencer_->on_raw_epoch(*epoch_);
      break;
    case Channel::kOdometer: {
      OdometerIncrement increment;
      *result = decoder_.decode(bytes, &increment);
      if (good()) sequencer_->on_odometer(increment);
      break;
    }
    case Channel::kEphemeris: {
      Ephemeris ephemeris;
      *result = decoder_.decode(bytes, &ephemeris);
      if (good()) sequencer_->on_ephemeris(ephemeris);
      break;
    }
    case Channel::kOrbitClock:
      *result = decoder_.decode(bytes, states_.get());
      if (good()) sequencer_->on_precise_states(*states_);
      break;
    case Channel::kCorrectedStates:
      *result = decoder_.decode(bytes, corrected_.get());
      if (good()) sequencer_->on_corrected_states(*corrected_);
      break;
    case Channel::kBiases:
      *result = decoder_.decode(bytes, biases_.get());
      if (good()) sequencer_->on_signal_biases(*biases_);
      break;
    case Channel::kIonosphere: {
      KlobucharModel model;
      *result = decoder_.decode(bytes, &model);
      if (good()) sequencer_->on_klobuchar(model);
      break;
    }
    case Channel::kAntenna:
      *result = decoder_.decode(bytes, antenna_.get());
      if (good()) sequencer_->on_antenna(*antenna_);
      break;
    case Channel::kCommand: {
      Command command;
      *result = decoder_.decode(bytes, &command);
      if (good()) sequencer_->on_command(command);
      break;
    }
    case Channel::kCheckpoint: {
      Checkpoint checkpoint;
      *result = decoder_.decode(bytes, &checkpoint);
      if (good()) sequencer_->on_checkpoint(checkpoint);
      break;
    }
    default:
      break;  // outputs are not ours to consume
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
