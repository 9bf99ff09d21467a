// The longest messages that core/base/capacity.h allows fit into the buffers and come back whole.
#include <leonav/antenna_t.hpp>
#include <leonav/biases_t.hpp>
#include <leonav/command_t.hpp>
#include <leonav/constraints_t.hpp>
#include <leonav/corrected_states_t.hpp>
#include <leonav/ephemeris_t.hpp>
#include <leonav/epoch_t.hpp>
#include <leonav/gnss_epoch_t.hpp>
#include <leonav/imu_t.hpp>
#include <leonav/ionosphere_t.hpp>
#include <leonav/leo_ephemeris_t.hpp>
#include <leonav/odometer_t.hpp>
#include <leonav/orbit_clock_t.hpp>
#include <leonav/signed_command_t.hpp>
#include <memory>
#include <vector>

#include "drivers/lcm/decode.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/message_sizes.h"
#include "drivers/lcm/wire.h"
#include "support/catch.h"

using namespace leonav;

TEST_CASE("an epoch at full capacity is encoded whole") {
  const auto report = std::make_unique<EpochReport>();
  report->time = GpsTime::from_week_and_tow(2300, 1000.0);
  report->satellites.resize(kMaxSatellites);
  report->aiding.resize(kMaxMeasurements);
  report->aiding.back().observation = 42.0;
  Encoder encoder;
  const ByteSpan bytes = encoder.encode(*report);
  CAPTURE(bytes.size());
  CHECK(bytes.size() > 31'000);
  CHECK(bytes.size() <= wire::kMaxMessageBytes);
  epoch_t message;
  const int size = static_cast<int>(bytes.size());
  REQUIRE(message.decode(bytes.data(), 0, size) == size);
  CHECK(message.n_satellites == static_cast<int>(kMaxSatellites));
  CHECK(message.n_aiding == static_cast<int>(kMaxMeasurements));
  CHECK(message.aiding.back().observation == 42.0);
}

TEST_CASE("constraints at full capacity are encoded whole, one component as it was met") {
  const auto report = std::make_unique<EpochReport>();
  report->time = GpsTime::from_week_and_tow(2300, 1000.0);
  report->sequence = 7;
  report->index = 5;
  report->constraint_reports.resize(kMaxConstraintReports);
  report->constraint_reports.back() = {
      report->time.plus_seconds(-0.2), 8, 9.5, 0.3, 0.04, 1.5, true, 0.1};
  Encoder encoder;
  const ByteSpan bytes = encoder.encode_constraints(*report);
  CHECK(bytes.size() <= wire::kMaxMessageBytes);
  constraints_t message;
  const int size = static_cast<int>(bytes.size());
  REQUIRE(message.decode(bytes.data(), 0, size) == size);
  CHECK(message.time_ns == report->time.nanoseconds());
  CHECK(message.sequence == 7);
  CHECK(message.schema == 1);
  CHECK(message.index == 5);
  REQUIRE(message.n == static_cast<int>(kMaxConstraintReports));
  const constraint_t& last = message.components.back();
  CHECK(last.time_ns == report->constraint_reports.back().time.nanoseconds());
  CHECK(last.component == 8);
  CHECK(last.observation == 9.5);
  CHECK(last.innovation == 0.3);
  CHECK(last.innovation_variance == 0.04);
  CHECK(last.test_ratio == 1.5F);
  CHECK(last.used == 1);
  CHECK(last.residual == 0.1);
  CHECK(message.components.front().used == 0);
}

TEST_CASE("precise states of every satellite that has a name come back") {
  std::vector<PreciseState> states;
  for (std::size_t i = 0; i < kMaxEphemerisSatellites; ++i) {
    PreciseState state;
    state.satellite = {System::kLeo, static_cast<std::uint16_t>(1 + i % 399)};
    state.time = GpsTime::from_week_and_tow(2300, 1000.0);
    state.p_e = {7e6, 1e6, 2e6};
    states.push_back(state);
  }
  Encoder encoder;
  Decoder decoder;
  PreciseStates back;
  CHECK(decoder.decode(encoder.encode(states, 1), &back).fault == InputFault::kNone);
  CHECK(back.size() == kMaxEphemerisSatellites);
}
TEST_CASE("corrected states and biases at full capacity come back") {
  CorrectedState state;
  state.satellite = {System::kGps, 5};
  state.time = state.corrected_at = state.orbit_corrected_at =
      GpsTime::from_week_and_tow(2300, 1000.0);
  state.p_e = {2e7, 1e7, 1e6};
  state.sigma_m = 0.1;
  const std::vector<CorrectedState> states(kMaxCorrectedStates, state);
  const std::vector<SignalBias> biases(
      kMaxBiases, SignalBias{state.satellite, {'1', 'C'}, BiasKind::kCode, state.time, 1.0});
  Encoder encoder;
  Decoder decoder;
  CorrectedStates states_back;
  SignalBiases biases_back;
  CHECK(decoder.decode(encoder.encode(states, {}, 1), &states_back).fault == InputFault::kNone);
  CHECK(states_back.size() == kMaxCorrectedStates);
  CHECK(decoder.decode(encoder.encode(biases, 1), &biases_back).fault == InputFault::kNone);
  CHECK(biases_back.size() == kMaxBiases);
}

TEST_CASE("messages without a list are short") {
  const std::vector<int> sizes = {
      imu_t().getEncodedSize(),           ephemeris_t().getEncodedSize(),
      leo_ephemeris_t().getEncodedSize(), ionosphere_t().getEncodedSize(),
      odometer_t().getEncodedSize(),      command_t().getEncodedSize(),
      signed_command_t().getEncodedSize()};
  for (const int bytes : sizes) CHECK(bytes <= static_cast<int>(wire::kMaxBytesWithoutList));
}

// Encoded size of a message whose list has so many elements.
template <typename Message, typename List>
int encoded_size(List Message::*list, std::size_t elements) {
  Message message;
  message.n = static_cast<std::int32_t>(elements);
  (message.*list).resize(elements);
  return message.getEncodedSize();
}

TEST_CASE("messages with lists at full capacity are no longer than their channel allows") {
  const std::pair<Channel, int> messages[] = {
      {Channel::kAntenna, encoded_size(&antenna_t::values_m, kMaxAntennaValues)},
      {Channel::kOrbitClock, encoded_size(&orbit_clock_t::states, kMaxEphemerisSatellites)},
      {Channel::kCorrectedStates, encoded_size(&corrected_states_t::states, kMaxCorrectedStates)},
      {Channel::kGnssEpoch, encoded_size(&gnss_epoch_t::observations, kMaxObservations)},
      {Channel::kBiases, encoded_size(&biases_t::biases, kMaxBiases)}};
  for (const auto& [channel, bytes] : messages) {
    CAPTURE(static_cast<int>(channel));
    CHECK(bytes > 0);
    CHECK(bytes <= static_cast<int>(most_message_bytes(channel)));
  }
}
