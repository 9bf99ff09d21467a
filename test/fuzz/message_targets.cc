// LCM messages, as any process on the network may send them.
#include <memory>

#include "core/navigator/interface/vehicle_defaults.h"
#include "daemon/messages/input_dispatch.h"
#include "drivers/lcm/decode_output.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/journal_marks.h"
#include "drivers/lcm/signed_command.h"
#include "test/fuzz/byte_script.h"
#include "test/fuzz/good_input.h"
#include "test/fuzz/target_groups.h"

namespace leonav::test {
namespace {

const GpsTime kNow = GpsTime::from_week_and_tow(2200, 345'600.0);

struct Codec {
  Decoder decoder;
  Encoder encoder;
};
Codec& codec() {
  static Codec one;
  return one;
}

// What was accepted must survive being sent again.
template <typename Value, typename Encode>
void decode_twice(FuzzBytes bytes, Encode encode) {
  static auto value = std::make_unique<Value>(), again = std::make_unique<Value>();
  Codec& c = codec();
  *value = Value();
  if (c.decoder.decode(bytes, value.get()).fault != InputFault::kNone) return;
  if constexpr (requires { value->empty(); }) {
    if (value->empty()) return;  // every element was left out: nobody sends such a list
  }
  const ByteSpan first = encode(*value);
  const std::vector<std::uint8_t> sent(first.begin(), first.end());
  *again = Value();
  const DecodeResult result = c.decoder.decode(sent, again.get());
  if (result.fault != InputFault::kNone || result.element_faults != 0) {
    throw Finding("a message is accepted, and refused when it is sent again: " +
                  std::string(to_string(result.fault)));
  }
  const ByteSpan second = encode(*again);
  if (!std::equal(sent.begin(), sent.end(), second.begin(), second.end())) {
    throw Finding("a message changes when it is sent again");
  }
}

template <typename Value>
void decode_twice(FuzzBytes bytes) {
  decode_twice<Value>(bytes, [](const Value& v) { return codec().encoder.encode(v, 1); });
}

template <typename List>
void decode_list_twice(FuzzBytes bytes) {
  decode_twice<List>(bytes, [](const List& list) {
    return codec().encoder.encode(std::span(list.data(), list.size()), 1);
  });
}

void decode_states(FuzzBytes bytes) {
  static auto states = std::make_unique<CorrectedStates>();
  states->clear();
  static_cast<void>(codec().decoder.decode(bytes, states.get()));
}

void decode_outputs(FuzzBytes bytes) {
  Solution solution;
  EpochInView view;
  Decision decision;
  static auto report = std::make_unique<SmootherReport>();
  static_cast<void>(decode_output(bytes, &solution));
  static_cast<void>(decode_output(bytes, &view));
  static_cast<void>(codec().decoder.decode(bytes, &decision));
  static_cast<void>(codec().decoder.decode(bytes, report.get()));
}

void decode_marks(FuzzBytes bytes) {
  static_cast<void>(decode_piece(bytes));
  static_cast<void>(decode_refused(bytes));
  static_cast<void>(decode_lost(bytes));
}

void decode_signed(FuzzBytes bytes) {
  static_cast<void>(decode_command_nonce(bytes));
  SignedCommand command;
  if (decode_signed_command(bytes, &command) != InputFault::kNone) return;
  const auto sent = encode_signed_command(command);
  SignedCommand again;
  if (decode_signed_command(sent, &again) != InputFault::kNone || again.mac != command.mac)
    throw Finding("a signed command changes when it is sent again");
}

// The first byte is the channel.
void run_decoder(FuzzBytes input) {
  ByteScript script(input);
  const auto channel = static_cast<Channel>(script.byte() % kChannelCount);
  const FuzzBytes bytes = script.rest();
  switch (channel) {
    case Channel::kImu:
      return decode_twice<ImuSample>(bytes);
    case Channel::kGnssEpoch:
      return decode_twice<RawEpoch>(bytes);
    case Channel::kEphemeris:
      return decode_twice<Ephemeris>(bytes);
    case Channel::kOrbitClock:
      return decode_list_twice<PreciseStates>(bytes);
    case Channel::kIonosphere:
      return decode_twice<KlobucharModel>(
          bytes, [](const KlobucharModel& m) { return codec().encoder.encode(m, kNow, 1); });
    case Channel::kAntenna:
      return decode_twice<AntennaPattern>(
          bytes, [](const AntennaPattern& p) { return codec().encoder.encode(p, kNow, 1); });
    case Channel::kCorrectedStates:
      return decode_states(bytes);
    case Channel::kBiases:
      return decode_list_twice<SignalBiases>(bytes);
    case Channel::kCommand:
      return decode_twice<Command>(
          bytes, [](const Command& c) { return codec().encoder.encode(c, kNow, 1); });
    case Channel::kOdometer:
      return decode_twice<OdometerIncrement>(bytes);
    case Channel::kCheckpoint:
      return decode_twice<Checkpoint>(bytes);
    case Channel::kPiece:
    case Channel::kRefused:
    case Channel::kLost:
      return decode_marks(bytes);
    case Channel::kCommandNonce:
      return decode_signed(bytes);
    default:
      return decode_outputs(bytes);
  }
}

// A list of messages: channel, length in two bytes, bytes.
void run_dispatch(FuzzBytes input) {
  const NavigatorConfig config = default_navigator_config(VehicleConfig().kind);
  CheckedStages stages;
  Sequencer sequencer(config, &stages);
  InputDispatch dispatch(&sequencer);
  for (ByteScript script(input); !script.empty();) {
    const auto channel = static_cast<Channel>(script.byte() % kChannelCount);
    const std::size_t length = script.half();
    const FuzzBytes bytes = script.take(length);
    if (is_replayed(channel)) dispatch.dispatch(channel, bytes);
  }
  require_recovery(config, &sequencer, &stages,
                   hidden_good_input(kNow, hash_of(input), is_chosen(input, 16)));
}

}  // namespace

std::vector<FuzzTarget> message_targets() {
  return {{"decoder", run_decoder}, {"dispatch", run_dispatch}};
}

}  // namespace leonav::test
