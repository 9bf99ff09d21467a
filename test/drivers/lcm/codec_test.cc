// What is encoded comes back; what is damaged is refused, without allocating by its claims.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <limits>
#include <random>
#include <vector>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/decode.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/wire.h"
#include "support/catch.h"

namespace {

using namespace leonav;
using Bytes = std::vector<std::uint8_t>;

Bytes copy(ByteSpan bytes) { return {bytes.begin(), bytes.end()}; }

ImuSample imu_sample() {
  ImuSample sample;
  sample.time = GpsTime::from_week_and_tow(2300, 1000.005);
  sample.interval_ns = 5'000'000;
  sample.delta_theta_b = {1e-3, -2e-3, 3e-3};
  sample.delta_velocity_b = {0.01, 0.02, -0.049};
  return sample;
}

RawEpoch raw_epoch(int satellites) {
  RawEpoch epoch;
  epoch.time = GpsTime::from_week_and_tow(2300, 1000.0);
  for (int i = 1; i <= satellites; ++i) {
    for (const SignalCode code : {SignalCode{'1', 'C'}, SignalCode{'2', 'W'}}) {
      SignalObservation observation;
      observation.satellite = {System::kGps, static_cast<std::uint16_t>(i)};
      observation.code = code;
      observation.pseudorange_m = 2.1e7 + i;
      observation.doppler_hz = -1000.0 + i;
      observation.cn0_dbhz = 40.0;
      observation.loss_of_lock = i == 2;
      epoch.observations.push_back(observation);
    }
  }
  return epoch;
}

}  // namespace

TEST_CASE("inputs survive the wire") {
  Encoder encoder;
  Decoder decoder;
  ImuSample sample;
  const DecodeResult result = decoder.decode(encoder.encode(imu_sample(), 7), &sample);
  REQUIRE(result.fault == InputFault::kNone);
  CHECK(result.sequence == 7);
  CHECK(sample.time == imu_sample().time);
  CHECK(sample.interval_ns == 5'000'000);
  CHECK(sample.delta_theta_b == imu_sample().delta_theta_b);
  CHECK(sample.delta_velocity_b == imu_sample().delta_velocity_b);

  const OdometerIncrement sent{sample.time, 100'000'000, -0.75, true};
  OdometerIncrement increment;
  REQUIRE(decoder.decode(encoder.encode(sent, 8), &increment).fault == InputFault::kNone);
  CHECK(increment.time == sent.time);
  CHECK(increment.interval_ns == sent.interval_ns);
  CHECK(increment.distance_m == sent.distance_m);
  CHECK(increment.sign_known);

  RawEpoch epoch;
  REQUIRE(decoder.decode(encoder.encode(raw_epoch(20), 1), &epoch).fault == InputFault::kNone);
  REQUIRE(epoch.observations.size() == 40);
  CHECK(epoch.observations[3].loss_of_lock);
  CHECK(epoch.observations[3].code == SignalCode{'2', 'W'});
  CHECK(epoch.observations[39].pseudorange_m == 2.1e7 + 20);
  CHECK(std::isnan(epoch.observations[0].carrier_cycles));
}

TEST_CASE("single bad observations are left out, copies and disorder dealt with") {
  Encoder encoder;
  Decoder decoder;
  RawEpoch epoch = raw_epoch(3), decoded;
  epoch.observations[0].satellite.number = 200;
  epoch.observations[1].pseudorange_m = std::numeric_limits<double>::infinity();
  std::swap(epoch.observations[4], epoch.observations[5]);
  epoch.observations[3] = epoch.observations[2];
  const DecodeResult result = decoder.decode(encoder.encode(epoch, 1), &decoded);
  CHECK(result.fault == InputFault::kNone);
  const auto bit = [](InputFault fault) { return 1U << static_cast<unsigned>(fault); };
  CHECK(result.element_faults ==
        (bit(InputFault::kOutOfRange) | bit(InputFault::kNotFinite) | bit(InputFault::kDuplicate)));
  REQUIRE(decoded.observations.size() == 2);
  CHECK(decoded.observations[0].code == SignalCode{'1', 'C'});
  CHECK(decoded.observations[1].code == SignalCode{'2', 'W'});
}

TEST_CASE("observations no signal can give are left out and counted; no carrier is none") {
  Encoder encoder;
  Decoder decoder;
  const auto bit = 1U << static_cast<unsigned>(InputFault::kNotSane);
  const auto decode_with = [&](double SignalObservation::*member, double value, bool is_good) {
    CAPTURE(value);
    RawEpoch epoch = raw_epoch(3), decoded;
    epoch.observations[2].*member = value;
    const DecodeResult result = decoder.decode(encoder.encode(epoch, 1), &decoded);
    CHECK(result.fault == InputFault::kNone);
    CHECK(result.element_faults == (is_good ? 0U : bit));
    CHECK(decoded.observations.size() == (is_good ? 6U : 5U));
    return decoded;
  };
  for (const double sign : {-1.0, 1.0}) {
    decode_with(&SignalObservation::pseudorange_m, sign * 1.1e9, false);
    decode_with(&SignalObservation::pseudorange_m, sign * 0.9e9, true);
    decode_with(&SignalObservation::carrier_cycles, sign * 1.1e11, false);
    decode_with(&SignalObservation::carrier_cycles, sign * 1e300, false);
    decode_with(&SignalObservation::carrier_cycles, sign * 0.9e11, true);
    decode_with(&SignalObservation::doppler_hz, sign * 1.1e6, false);
    decode_with(&SignalObservation::doppler_hz, sign * 3e5, true);
  }
  decode_with(&SignalObservation::cn0_dbhz, -1.0, false);
  decode_with(&SignalObservation::cn0_dbhz, 101.0, false);
  decode_with(&SignalObservation::cn0_dbhz, 60.0, true);
  const RawEpoch none = decode_with(&SignalObservation::carrier_cycles, 0.0, true);
  CHECK(std::isnan(none.observations[2].carrier_cycles));
}

TEST_CASE("wrong values are named") {
  Encoder encoder;
  Decoder decoder;
  ImuSample sample = imu_sample(), out;
  sample.delta_theta_b[1] = std::numeric_limits<double>::quiet_NaN();
  CHECK(decoder.decode(encoder.encode(sample, 1), &out).fault == InputFault::kNotFinite);
  sample = imu_sample();
  sample.interval_ns = 0;
  CHECK(decoder.decode(encoder.encode(sample, 1), &out).fault == InputFault::kOutOfRange);
  Bytes bytes = copy(encoder.encode(imu_sample(), 1));
  bytes[27] = 9;
  CHECK(decoder.decode(bytes, &out).fault == InputFault::kUnknownSchema);
  CHECK(decoder.decode(Bytes(wire::kMaxMessageBytes + 1, 0), &out).fault == InputFault::kTooMany);
  OdometerIncrement increment{sample.time, 0, 1.0, true};
  CHECK(decoder.decode(encoder.encode(increment, 1), &increment).fault == InputFault::kOutOfRange);
  increment = {sample.time, 100, std::numeric_limits<double>::infinity(), true};
  CHECK(decoder.decode(encoder.encode(increment, 1), &increment).fault == InputFault::kNotFinite);
  increment.distance_m = 1.0;
  bytes = copy(encoder.encode(increment, 1));
  bytes.back() = 2;  // neither known nor unknown
  CHECK(decoder.decode(bytes, &increment).fault == InputFault::kOutOfRange);
  bytes[27] = 9;
  CHECK(decoder.decode(bytes, &increment).fault == InputFault::kUnknownSchema);
  Ephemeris ephemeris;  // all zero: not an orbit
  ephemeris.satellite = {System::kGps, 3};
  ephemeris.toe = ephemeris.toc = imu_sample().time;
  CHECK(decoder.decode(encoder.encode(ephemeris, 1), &ephemeris).fault == InputFault::kNotSane);
}

TEST_CASE("elements of a LEO satellite come back with their rates, others in their old message") {
  Encoder encoder;
  Decoder decoder;
  Ephemeris sent;
  sent.satellite = {System::kLeo, 150};
  sent.toe = sent.toc = sent.transmission_time = GpsTime::from_week_and_tow(2200, 345600.0);
  sent.sqrt_a = 2711.0;
  sent.eccentricity = 0.001;
  sent.i0 = 1.5;
  sent.delta_n = -3e-7;
  sent.crc = 1400.0;
  sent.af0 = 1e-5;
  sent.issue = 7;
  sent.a_dot = 0.19;
  sent.delta_n_dot = -6e-11;
  const Bytes bytes = copy(encoder.encode(sent, 5));
  Ephemeris back;
  const DecodeResult result = decoder.decode(bytes, &back);
  REQUIRE(result.fault == InputFault::kNone);
  CHECK(result.sequence == 5);
  CHECK(back.satellite == sent.satellite);
  CHECK(back.toe == sent.toe);
  CHECK(back.transmission_time == sent.transmission_time);
  CHECK(back.issue == sent.issue);
  for (double Ephemeris::*const element :
       {&Ephemeris::sqrt_a, &Ephemeris::eccentricity, &Ephemeris::i0, &Ephemeris::delta_n,
        &Ephemeris::crc, &Ephemeris::af0, &Ephemeris::a_dot, &Ephemeris::delta_n_dot}) {
    CHECK(back.*element == sent.*element);
  }
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<long>(size));
    CHECK(decoder.decode(cut, &back).fault != InputFault::kNone);
  }
  Ephemeris bad = sent;
  bad.delta_n_dot = std::numeric_limits<double>::quiet_NaN();
  CHECK(decoder.decode(encoder.encode(bad, 1), &back).fault == InputFault::kNotFinite);
  bad.delta_n_dot = 1.0;
  CHECK(decoder.decode(encoder.encode(bad, 1), &back).fault == InputFault::kNotSane);
  Bytes other = bytes;
  other[28] = 0;  // GPS in the message for LEO
  other[30] = 5;
  CHECK(decoder.decode(other, &back).fault == InputFault::kOutOfRange);
  // The other systems' message is that of journals before: its size is fixed.
  sent.satellite = {System::kGps, 5};
  sent.sqrt_a = 5153.6;
  sent.a_dot = sent.delta_n_dot = 0.0;
  sent.delta_n = 4e-9;
  const Bytes old = copy(encoder.encode(sent, 1));
  CHECK(old.size() == 8 + 52 + 21 * 8);
  CHECK(decoder.decode(old, &back).fault == InputFault::kNone);
}

TEST_CASE("a count larger than the message or the capacity never reaches the allocator") {
  Encoder encoder;
  Decoder decoder;
  RawEpoch epoch;
  Bytes bytes = copy(encoder.encode(raw_epoch(20), 1));
  for (const std::uint32_t count : {0x7fffffffU, 0x80000000U, 0xffffffffU, 513U, 512U, 41U, 39U}) {
    for (std::size_t i = 0; i < 4; ++i)
      bytes[28 + i] = static_cast<std::uint8_t>(count >> (24 - 8 * i));
    CHECK(decoder.decode(bytes, &epoch).fault != InputFault::kNone);
  }
}

TEST_CASE("truncated and flipped messages never crash and never change a refused output") {
  Encoder encoder;
  Decoder decoder;
  std::mt19937 random(1);
  const Bytes good = copy(encoder.encode(raw_epoch(12), 1));
  RawEpoch epoch;
  for (std::size_t size = 0; size < good.size(); ++size) {
    CHECK(
        decoder.decode(Bytes(good.begin(), good.begin() + static_cast<long>(size)), &epoch).fault !=
        InputFault::kNone);
  }
  for (int i = 0; i < 20000; ++i) {
    Bytes bytes = good;
    for (int flips = 0; flips < 1 + i % 4; ++flips)
      bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    ImuSample sample;
    PreciseStates states;
    Ephemeris ephemeris;
    if (decoder.decode(bytes, &epoch).fault == InputFault::kNone) {
      REQUIRE(epoch.observations.size() <= 24);
    }
    REQUIRE(decoder.decode(bytes, &sample).fault != InputFault::kNone);
    REQUIRE(decoder.decode(bytes, &ephemeris).fault != InputFault::kNone);
    REQUIRE(decoder.decode(bytes, &states).fault != InputFault::kNone);
  }
}

TEST_CASE("precise states come back with flags, clocks without positions, and nothing else") {
  std::vector<PreciseState> states(4);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < states.size(); ++i) {
    states[i].satellite = {System::kGalileo, static_cast<std::uint16_t>(i + 1)};
    states[i].time = GpsTime::from_week_and_tow(2300, 900.0);
    states[i].p_e = {2.9e7, -1e6, 2e6};
    states[i].clock_s = -1e-4;
  }
  states[0].clock_event = states[0].orbit_predicted = true;
  states[1].maneuver = states[1].clock_predicted = true;
  states[2].p_e.setConstant(nan);
  states[3].clock_s = nan;
  Encoder encoder;
  Decoder decoder;
  PreciseStates back;
  REQUIRE(decoder.decode(copy(encoder.encode(states, 1)), &back).element_faults == 0);
  REQUIRE(back.size() == 4);
  CHECK((back[0].clock_event && back[0].orbit_predicted));
  CHECK_FALSE((back[0].maneuver || back[0].clock_predicted));
  CHECK((back[1].maneuver && back[1].clock_predicted));
  CHECK_FALSE((back[1].clock_event || back[1].orbit_predicted));
  CHECK(back[2].is_clock_only());
  CHECK(back[2].clock_s == -1e-4);
  CHECK(std::isnan(back[3].clock_s));
  CHECK(back[3].p_e == states[3].p_e);
  // A position half missing, and neither position nor clock: refused, and nothing else with them.
  states[0].p_e.y() = nan;
  states[2].clock_s = nan;
  CHECK(decoder.decode(copy(encoder.encode(states, 2)), &back).element_faults != 0);
  REQUIRE(back.size() == 2);
  CHECK(back[0].maneuver);
}

TEST_CASE("event logs agree with liblcm's, both ways; damage is reported") {
  const std::string path = std::filesystem::temp_directory_path() / "leonav_event_log_test.lcmlog";
  const Bytes data = {1, 2, 3, 0xED, 0xA1};
  {
    EventLogWriter writer(path);
    REQUIRE(writer.write(123456, "LEONAV_IMU", data));
    REQUIRE(writer.write(-5, "X", {}));
    REQUIRE(writer.flush());
  }
  {
    lcm::LogFile theirs(path, "r");
    const lcm::LogEvent* event = theirs.readNextEvent();
    REQUIRE(event != nullptr);
    CHECK(event->channel == "LEONAV_IMU");
    CHECK(event->timestamp == 123456);
    REQUIRE(event->datalen == 5);
    CHECK(Bytes(static_cast<std::uint8_t*>(event->data),
                static_cast<std::uint8_t*>(event->data) + 5) == data);
  }
  LogEvent event;
  {
    EventLogReader mine(path);
    REQUIRE(mine.next(&event));
    CHECK(event.data == data);
    REQUIRE(mine.next(&event));
    CHECK_FALSE(mine.next(&event));
    CHECK_FALSE(mine.truncated());
  }
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  {
    EventLogReader mine(path);
    REQUIRE(mine.next(&event));
    CHECK_FALSE(mine.next(&event));
    CHECK(mine.truncated());
  }
  std::FILE* file = std::fopen(path.c_str(), "r+b");
  std::fputs("junk", file);
  std::fclose(file);
  EventLogReader damaged(path);
  CHECK_THROWS_AS(damaged.next(&event), EventLogError);
  std::filesystem::remove(path);
  CHECK_THROWS_AS(EventLogReader(path), EventLogError);
}
TEST_CASE("corrected states and biases come back, and wrong ones alone are left out") {
  std::vector<CorrectedState> states(3);
  const GpsTime time = GpsTime::from_week_and_tow(2300, 900.0);
  for (std::size_t i = 0; i < states.size(); ++i) {
    states[i].satellite = {System::kGalileo, static_cast<std::uint16_t>(i + 1)};
    states[i].time = time;
    states[i].corrected_at = time.plus_seconds(-7.5);
    states[i].orbit_corrected_at = time.plus_seconds(-30.0);
    states[i].at_antenna = i == 1;
    states[i].issue = 74;
    states[i].p_e = {2.9e7, -1e6, 2e6};
    states[i].v_e = {1e3, 2e3, -3e3};
    states[i].clock_s = -1e-4;
    states[i].clock_drift = 1e-11;
    states[i].sigma_m = 0.25;
  }
  Encoder encoder;
  Decoder decoder;
  CorrectedStates back;
  const CorrectionSource source{270, 1, 3};
  REQUIRE(decoder.decode(copy(encoder.encode(states, source, 5)), &back).element_faults == 0);
  REQUIRE(back.size() == 3);
  CHECK(back[1].satellite == states[1].satellite);
  CHECK(back[1].time == time);
  CHECK(back[1].corrected_at == states[1].corrected_at);
  CHECK(back[1].orbit_corrected_at == states[1].orbit_corrected_at);
  CHECK((back[1].at_antenna && !back[0].at_antenna));
  CHECK(back[1].issue == 74);
  CHECK(back[1].p_e == states[1].p_e);
  CHECK(back[1].v_e == states[1].v_e);
  CHECK(back[1].clock_s == states[1].clock_s);
  CHECK(back[1].clock_drift == states[1].clock_drift);
  CHECK(back[1].sigma_m == 0.25);
  states[0].clock_s = std::numeric_limits<double>::quiet_NaN();
  states[2].p_e *= 10.0;
  CHECK(decoder.decode(copy(encoder.encode(states, source, 6)), &back).element_faults != 0);
  REQUIRE(back.size() == 1);
  CHECK(back[0].satellite == states[1].satellite);

  std::vector<SignalBias> biases(3);
  for (std::size_t i = 0; i < biases.size(); ++i) {
    biases[i] = {{System::kGps, static_cast<std::uint16_t>(i + 1)},
                 {'2', 'W'},
                 i == 1 ? BiasKind::kPhase : BiasKind::kCode,
                 time,
                 -1.25};
  }
  SignalBiases biases_back;
  REQUIRE(decoder.decode(copy(encoder.encode(biases, 7)), &biases_back).element_faults == 0);
  REQUIRE(biases_back.size() == 3);
  CHECK(biases_back[1].kind == BiasKind::kPhase);
  CHECK(biases_back[1].code == SignalCode{'2', 'W'});
  CHECK(biases_back[1].bias_m == -1.25);
  CHECK(biases_back[1].time == time);
  biases[0].bias_m = 1e6;
  CHECK(decoder.decode(copy(encoder.encode(biases, 8)), &biases_back).element_faults != 0);
  CHECK(biases_back.size() == 2);
}

TEST_CASE("damaged corrected states and biases never crash and are refused or sane") {
  Encoder encoder;
  Decoder decoder;
  std::mt19937 random(2);
  std::vector<CorrectedState> states(5);
  std::vector<SignalBias> biases(5);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const SatelliteId id{System::kGps, static_cast<std::uint16_t>(i + 1)};
    const GpsTime time = GpsTime::from_week_and_tow(2300, 900.0);
    states[i] = {id, time, time, time, true, 5, {2e7, 1e7, 1e6}, {1e3, 2e3, 3e3}, 1e-4, 1e-11, 0.1};
    biases[i] = {id, {'1', 'C'}, BiasKind::kCode, time, 0.5};
  }
  const std::array<Bytes, 2> messages = {copy(encoder.encode(states, {1, 2, 3}, 1)),
                                         copy(encoder.encode(biases, 1))};
  CorrectedStates states_back;
  SignalBiases biases_back;
  for (const Bytes& good : messages) {
    for (std::size_t size = 0; size < good.size(); ++size) {
      const Bytes cut(good.begin(), good.begin() + static_cast<long>(size));
      CHECK(decoder.decode(cut, &states_back).fault != InputFault::kNone);
      CHECK(decoder.decode(cut, &biases_back).fault != InputFault::kNone);
    }
    for (int i = 0; i < 10'000; ++i) {
      Bytes bytes = good;
      for (int flips = 0; flips < 1 + i % 4; ++flips)
        bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
      if (decoder.decode(bytes, &states_back).fault == InputFault::kNone) {
        for (const CorrectedState& state : states_back) REQUIRE(state.p_e.norm() < 1e8);
      }
      if (decoder.decode(bytes, &biases_back).fault == InputFault::kNone) {
        for (const SignalBias& bias : biases_back) REQUIRE(is_sane(bias));
      }
    }
  }
}
