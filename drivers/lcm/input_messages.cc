#include "drivers/lcm/input_messages.h"

namespace leonav {

InputMessage InputMessages::encode(const ImuSample& sample) {
  return {Channel::kImu, encoder_.encode(sample, next_sequence(Channel::kImu))};
}

InputMessage InputMessages::encode(const OdometerIncrement& increment) {
  return {Channel::kOdometer, encoder_.encode(increment, next_sequence(Channel::kOdometer))};
}

InputMessage InputMessages::encode(const RawEpoch& epoch) {
  return {Channel::kGnssEpoch, encoder_.encode(epoch, next_sequence(Channel::kGnssEpoch))};
}

InputMessage InputMessages::encode(const Ephemeris& ephemeris) {
  return {Channel::kEphemeris, encoder_.encode(ephemeris, next_sequence(Channel::kEphemeris))};
}

InputMessage InputMessages::encode(const KlobucharModel& model, GpsTime time) {
  return {Channel::kIonosphere, encoder_.encode(model, time, next_sequence(Channel::kIonosphere))};
}

InputMessage InputMessages::encode(const AntennaPattern& pattern, GpsTime time) {
  return {Channel::kAntenna, encoder_.encode(pattern, time, next_sequence(Channel::kAntenna))};
}

InputMessage InputMessages::encode(std::span<const PreciseState> states) {
  return {Channel::kOrbitClock, encoder_.encode(states, next_sequence(Channel::kOrbitClock))};
}

InputMessage InputMessages::encode(std::span<const CorrectedState> states,
                                   const CorrectionSource& source) {
  return {Channel::kCorrectedStates,
          encoder_.encode(states, source, next_sequence(Channel::kCorrectedStates))};
}

InputMessage InputMessages::encode(std::span<const SignalBias> biases) {
  return {Channel::kBiases, encoder_.encode(biases, next_sequence(Channel::kBiases))};
}

}  // namespace leonav
