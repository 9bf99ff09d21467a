// What leonav-connect publishes of an RTCM 3 stream, from messages encoded here by the standard's
// tables.
#include "tools/connect/formats/receivers/rtcm3_format.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/base/calendar.h"
#include "core/gnss/orbits/satellite_state.h"
#include "core/gnss/signals/signal.h"
#include "drivers/binary/crc24q.h"
#include "drivers/lcm/decode.h"
#include "support/catch.h"

namespace leonav {
namespace {

// Bits, the most significant first.
class Bits {
 public:
  Bits& add(std::uint64_t value, int count) {
    for (int bit = count - 1; bit >= 0; --bit) bits_.push_back(value >> bit & 1U);
    return *this;
  }
  // With preamble, length and checksum.
  std::vector<std::uint8_t> frame() const {
    std::vector<std::uint8_t> bytes((bits_.size() + 7) / 8);
    for (std::size_t i = 0; i < bits_.size(); ++i)
      if (bits_[i] != 0) bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | 0x80U >> i % 8);
    bytes.insert(bytes.begin(), {0xD3, static_cast<std::uint8_t>(bytes.size() >> 8),
                                 static_cast<std::uint8_t>(bytes.size() & 0xFFU)});
    std::uint32_t crc = 0;
    for (const std::uint8_t byte : bytes) crc = crc24q_next(crc, byte);
    for (const int shift : {16, 8, 0})
      bytes.push_back(static_cast<std::uint8_t>(crc >> shift & 0xFFU));
    return bytes;
  }

 private:
  std::vector<std::uint64_t> bits_;
};

// MSM4 of satellite 7 with one signal, whose mask is 1 << (32 - 2) for L1 C/A: 75 ms and a half.
std::vector<std::uint8_t> msm4(int number, std::uint64_t time_ms, std::uint64_t station = 1) {
  Bits bits;
  bits.add(static_cast<std::uint64_t>(number), 12).add(station, 12).add(time_ms, 30).add(0, 1);
  bits.add(0, 3).add(0, 7).add(0, 2).add(0, 2).add(0, 1).add(0, 3);
  bits.add(std::uint64_t{1} << (64 - 7), 64).add(std::uint64_t{1} << (32 - 2), 32).add(1, 1);
  bits.add(75, 8).add(512, 10);
  bits.add(0, 15).add(0, 22).add(5, 4).add(0, 1).add(45, 6);
  return bits.frame();
}

struct Epochs : MessageTarget {
  void take(Channel channel, ByteSpan bytes) override {
    REQUIRE(channel == Channel::kGnssEpoch);
    RawEpoch epoch;
    REQUIRE(Decoder().decode(bytes, &epoch).fault == InputFault::kNone);
    list.push_back(epoch);
  }
  std::vector<RawEpoch> list;
};

// Of 2024-03-20, a Wednesday: 04:00 GPS time.
const GpsTime kTime = from_calendar({2024, 3, 20, 4, 0, 0.0});
constexpr std::uint64_t kOfWeek_ms = (3 * 24 + 4) * 3'600'000ULL;

std::int64_t host_ns(GpsTime time) {
  return time.nanoseconds() + (315'964'800 - leap_seconds(time)) * kNanosecondsPerSecond;
}

}  // namespace

TEST_CASE("Observations are published with the week of the host's clock, or of the day told",
          "[connect]") {
  const bool is_live = GENERATE(true, false);
  Epochs epochs;
  MessageOutput output(&epochs);
  GpsClock clock(TimeReference::kGnss, 0.05);
  Rtcm3Format format(is_live ? GpsTime() : kTime.plus_seconds(-2.5 * 86'400), 30.0, &clock,
                     &output);
  for (int second = 0; second < 3; ++second) {
    const auto bytes = msm4(1074, kOfWeek_ms + 1000U * static_cast<unsigned>(second));
    // A file is read at any time.
    const GpsTime now = is_live ? kTime.plus_seconds(second + 0.1) : kTime.plus_seconds(9e6);
    format.feed(bytes, host_ns(now));
  }
  format.finish();
  REQUIRE(epochs.list.size() == 3);
  CHECK(epochs.list[2].time == kTime.plus_seconds(2.0));
  REQUIRE(epochs.list[2].observations.size() == 1);
  const SignalObservation& observation = epochs.list[2].observations.front();
  CHECK(observation.satellite == SatelliteId{System::kGps, 7});
  CHECK(observation.pseudorange_m == Approx(0.0755 * 299'792'458.0).epsilon(1e-12));
  CHECK(format.counts().frames == 3);
  CHECK(format.counts().messages == 3);
  CHECK(format.counts().damaged == 0);
  CHECK(format.data_time()->nanoseconds == kTime.plus_seconds(2.0).nanoseconds());
  CHECK(format.detail() == "1 signals in the last epoch, 0 ephemerides");
}

TEST_CASE("A stream without what is needed is told with what it has", "[connect]") {
  Epochs epochs;
  MessageOutput output(&epochs);
  GpsClock clock(TimeReference::kGnss, 0.05);
  Rtcm3Format format(kTime, 30.0, &clock, &output);
  std::vector<std::uint8_t> damaged = msm4(1074, kOfWeek_ms);
  damaged[10] ^= 0x10U;
  format.feed(damaged, host_ns(kTime));
  format.feed(msm4(1084, 3'600'000), host_ns(kTime));
  format.finish();
  CHECK(epochs.list.empty());
  CHECK(format.counts().damaged == 1);
  CHECK(format.counts().frames == 1);
  CHECK(format.why_no_messages().find("1084") != std::string::npos);
  CHECK(format.why_no_messages().find("MSM4 to MSM7") != std::string::npos);
}

namespace {

struct PublishedCorrections : MessageTarget {
  void take(Channel channel, ByteSpan bytes) override {
    ++counts[channel];
    if (channel != Channel::kCorrectedStates) return;
    CorrectedStates received;
    REQUIRE(Decoder().decode(bytes, &received).element_faults == 0);
    states.insert(states.end(), received.begin(), received.end());
  }
  std::map<Channel, int> counts;
  std::vector<CorrectedState> states;
};

// 1060 of GPS 7 with issue 77: 1 m along the radius, a clock of half a metre.
std::vector<std::uint8_t> orbit_and_clock(std::uint64_t of_week_s) {
  Bits bits;
  bits.add(1060, 12).add(of_week_s, 20).add(0, 4).add(0, 1).add(0, 1).add(3, 4).add(270, 16);
  bits.add(1, 4).add(1, 6);
  bits.add(7, 6).add(77, 8).add(10'000, 22).add(0, 20).add(0, 20).add(0, 21).add(0, 19).add(0, 19);
  bits.add(5'000, 22).add(0, 21).add(0, 27);
  return bits.frame();
}

// 1059 of GPS 7: L1 C/A 0.25 m.
std::vector<std::uint8_t> code_bias(std::uint64_t of_week_s) {
  Bits bits;
  bits.add(1059, 12).add(of_week_s, 20).add(0, 4).add(0, 1).add(3, 4).add(270, 16).add(1, 4);
  bits.add(1, 6).add(7, 6).add(1, 5).add(0, 5).add(25, 14);
  return bits.frame();
}

Ephemeris elements(std::uint16_t issue) {
  Ephemeris e;
  e.satellite = {System::kGps, 7};
  e.toe = e.toc = kTime;
  e.issue = issue;
  e.sqrt_a = 5153.7;
  e.i0 = 0.96;
  return e;
}

}  // namespace

namespace {

// 1019 of a satellite for the two hours in which kTime is, of week 2306.
std::vector<std::uint8_t> gps_ephemeris(std::uint64_t satellite) {
  const std::uint64_t toe = kOfWeek_ms / 1000 / 16;
  Bits bits;
  bits.add(1019, 12).add(satellite, 6).add(2306 % 1024, 10).add(0, 4).add(1, 2).add(0, 14);
  bits.add(45, 8).add(toe, 16).add(0, 8).add(0, 16).add(1000, 22).add(45, 10);
  bits.add(0, 16).add(0, 16).add(100, 32).add(0, 16).add(85'899'345, 32).add(0, 16);
  bits.add(2'702'049'280, 32).add(toe, 16).add(0, 16).add(1000, 32).add(0, 16);
  bits.add(654'982'758, 32).add(0, 16).add(1000, 32).add(0, 24).add(0, 8).add(0, 6).add(0, 2);
  return bits.frame();
}

struct Ephemerides : MessageTarget {
  void take(Channel channel, ByteSpan bytes) override {
    if (channel != Channel::kEphemeris) return;
    Ephemeris ephemeris;
    REQUIRE(Decoder().decode(bytes, &ephemeris).fault == InputFault::kNone);
    list.push_back(ephemeris);
  }
  std::vector<Ephemeris> list;
};

}  // namespace

TEST_CASE("Ephemerides are sent at the epochs' time, however wrong the host's clock is",
          "[connect]") {
  const double error_s = GENERATE(-86'400.0, 0.0, 1200.0);
  Ephemerides ephemerides;
  MessageOutput output(&ephemerides);
  GpsClock clock(TimeReference::kGnss, 0.05);
  Rtcm3Format format(GpsTime(), 0.0, &clock, &output);
  const auto arrival_ns = [&](double s) { return host_ns(kTime.plus_seconds(s + error_s)); };
  // Before the first epoch only the week is known: it counts as sent when its use began.
  format.feed(gps_ephemeris(3), arrival_ns(-0.5));
  for (unsigned second = 0; second < 3; ++second) {
    format.feed(msm4(1074, kOfWeek_ms + 1000U * second), arrival_ns(second + 0.1));
    format.feed(gps_ephemeris(4 + second), arrival_ns(second + 0.6));
  }
  // The epochs stop, and time goes on.
  format.feed(gps_ephemeris(7), arrival_ns(602.1));
  REQUIRE(ephemerides.list.size() == 5);
  CHECK(ephemerides.list[0].transmission_time == kTime.plus_seconds(-7200.0));
  for (unsigned second = 0; second < 3; ++second) {
    CHECK(seconds_between(ephemerides.list[1 + second].transmission_time,
                          kTime.plus_seconds(second)) == Approx(0.5).margin(1e-6));
  }
  CHECK(seconds_between(ephemerides.list[4].transmission_time, kTime) ==
        Approx(602.0).margin(1e-6));
}

TEST_CASE("While nothing confirms its week, a host's clock without synchronisation is mentioned",
          "[connect]") {
  const std::string sentence =
      "the host's clock is not synchronised, and the week of these messages is taken from it";
  PublishedCorrections messages;
  MessageOutput output(&messages);
  bool is_unsynchronised = true;
  GpsClock clock(TimeReference::kGnss, 0.05, HostClock::wall_ns(),
                 [&] { return is_unsynchronised; });
  Rtcm3Format format(GpsTime(), 30.0, &clock, &output);
  const auto doubts = [&] { return format.detail().find(sentence) != std::string::npos; };
  const auto feed_epochs = [&](double host_error_s) {
    for (unsigned s = 0; s < 3; ++s)
      format.feed(msm4(1074, kOfWeek_ms + 1000U * s),
                  host_ns(kTime.plus_seconds(s + 0.1 + host_error_s)));
  };

  SECTION("its own epochs do not confirm it, and they are published") {
    feed_epochs(0.0);
    CHECK(doubts());
    CHECK(messages.counts[Channel::kGnssEpoch] == 3);
    is_unsynchronised = false;
    CHECK_FALSE(doubts());
  }
  SECTION("an ephemeris confirms it, and a clock that is set needs it anew") {
    feed_epochs(0.0);
    format.feed(gps_ephemeris(3), host_ns(kTime.plus_seconds(3.0)));
    CHECK_FALSE(doubts());
    const std::int64_t now_ns = host_ns(kTime);
    for (int k = 0; k < HostClock::kComparisons; ++k)
      clock.compare_host(now_ns + 86'400 * kNanosecondsPerSecond, now_ns);
    CHECK(doubts());
    // A repeated one will do.
    format.feed(gps_ephemeris(3), host_ns(kTime.plus_seconds(4.0)));
    CHECK_FALSE(doubts());
  }
  SECTION("an ephemeris of a neighbouring week does not") {
    feed_epochs(7.0 * 86'400.0);
    format.feed(gps_ephemeris(3), host_ns(kTime.plus_seconds(7.0 * 86'400.0 + 3.0)));
    CHECK(messages.counts[Channel::kEphemeris] == 1);
    CHECK(doubts());
  }
  SECTION("a receiver that knows its week does") {
    feed_epochs(0.0);
    ReceiverOutput receiver(30.0, &clock, &output);
    RawEpoch epoch;
    epoch.time = kTime.plus_seconds(8.0 * 86'400.0);  // as long as it does not know it yet
    receiver.send(epoch, host_ns(kTime));
    CHECK(doubts());
    epoch.time = kTime.plus_seconds(1.0);
    receiver.send(epoch, host_ns(kTime.plus_seconds(1.0)));
    CHECK_FALSE(doubts());
  }
  SECTION("where all ephemerides are refused, it is told with the remedy") {
    format.feed(gps_ephemeris(3), host_ns(kTime.plus_seconds(-300.0 * 86'400.0)));
    CHECK(format.counts().messages == 0);
    CHECK_THAT(format.why_no_messages(), Catch::Contains(sentence));
  }
  SECTION("a file has its day from the configuration") {
    Rtcm3Format file(kTime, 30.0, &clock, &output);
    file.feed(msm4(1074, kOfWeek_ms), host_ns(kTime));
    file.finish();
    CHECK_THAT(file.detail(), !Catch::Contains("synchronised"));
  }
}

TEST_CASE("Ephemerides of another week than the host's clock are told, also once it is right",
          "[connect]") {
  Ephemerides ephemerides;
  MessageOutput output(&ephemerides);
  GpsClock clock(TimeReference::kGnss, 0.05);
  Rtcm3Format format(GpsTime(), 0.0, &clock, &output);
  const double error_days = GENERATE(-5.0, 5.0, 12.0);
  const auto send = [&](std::uint64_t satellite, double days) {
    format.feed(gps_ephemeris(satellite), host_ns(kTime.plus_seconds(days * 86'400.0)));
  };
  send(3, error_days);
  send(4, error_days);
  CHECK(format.detail().find("the host's clock") == std::string::npos);
  send(5, error_days);
  CHECK_THAT(format.detail(), Catch::Contains("of another week than the host's clock shows"));
  send(6, 0.0);
  CHECK(format.detail().find("the host's clock") == std::string::npos);
  // Wrong by less than half a week it gives the right one.
  for (const double days : {-3.0, -2.0, 2.0, 3.0}) send(7, days);
  CHECK(format.detail().find("the host's clock") == std::string::npos);
}

TEST_CASE("Around a week's end ephemerides may be of the week before or behind", "[connect]") {
  Ephemerides ephemerides;
  MessageOutput output(&ephemerides);
  GpsClock clock(TimeReference::kGnss, 0.05);
  Rtcm3Format format(GpsTime(), 0.0, &clock, &output);
  const GpsTime next_week = GpsTime::from_week_and_tow(2307, 0.0);
  for (std::uint64_t k = 0; k < 5; ++k) {
    format.feed(gps_ephemeris(3 + k), host_ns(next_week.plus_seconds(3600.0)));
  }
  CHECK(format.detail().find("the host's clock") == std::string::npos);
  for (std::uint64_t k = 0; k < 3; ++k) {
    format.feed(gps_ephemeris(8 + k), host_ns(next_week.plus_seconds(5.0 * 3600.0)));
  }
  CHECK_THAT(format.detail(), Catch::Contains("of another week than the host's clock shows"));
}

TEST_CASE("A receiver that comes back with another station's number is read", "[connect]") {
  Epochs epochs;
  MessageOutput output(&epochs);
  GpsClock clock(TimeReference::kGnss, 0.05);
  Rtcm3Format format(GpsTime(), 30.0, &clock, &output);
  format.on_open();
  format.feed(msm4(1074, kOfWeek_ms, 100), host_ns(kTime));
  format.on_open();
  format.feed(msm4(1074, kOfWeek_ms + 1000, 200), host_ns(kTime.plus_seconds(1.0)));
  CHECK(epochs.list.size() == 2);
  CHECK(format.counts().refused == 0);
  CHECK_THAT(format.detail(), Catch::Contains("its station has changed 1 times, the last from "
                                              "100 to 200"));
}

namespace {

struct StationRig {
  void send(std::uint64_t ms, std::uint64_t station) {
    format.feed(msm4(1074, kOfWeek_ms + ms, station),
                host_ns(kTime.plus_nanoseconds(static_cast<std::int64_t>(ms) * 1'000'000)));
  }
  double last_s() const { return seconds_between(epochs.list.back().time, kTime); }
  Epochs epochs;
  MessageOutput output{&epochs};
  GpsClock clock{TimeReference::kGnss, 0.05};
  Rtcm3Format format{GpsTime(), 30.0, &clock, &output};
};

}  // namespace

TEST_CASE("A station with rare epochs is used until it has missed three of them", "[connect]") {
  StationRig rig;
  rig.format.on_open();
  rig.send(0, 100);
  // From then on another station sends each second, half a second later.
  for (std::uint64_t s = 10; s <= 120; ++s) {
    if (s % 10 == 0 && s <= 60) rig.send(1000 * s, 100);
    rig.send(1000 * s + 500, 200);
    if (s < 90) {
      CHECK(rig.epochs.list.size() == 1 + std::min<std::size_t>(s / 10, 6));
    } else {
      CHECK(rig.last_s() == Approx(static_cast<double>(s) + 0.5));
    }
  }
}

TEST_CASE("The time of one other station does not count for a third", "[connect]") {
  StationRig rig;
  rig.format.on_open();
  for (std::uint64_t s = 0; s < 4; ++s) rig.send(1000 * s, 100);
  for (std::uint64_t s = 4; s < 7; ++s) rig.send(1000 * s, 200);
  for (std::uint64_t s = 7; s < 12; ++s) rig.send(1000 * s, 300);
  CHECK(rig.epochs.list.size() == 4);
  for (std::uint64_t s = 12; s < 40; ++s) rig.send(1000 * s, 300);
  CHECK(rig.last_s() == Approx(39.0));
}

TEST_CASE("Where two others send at the same time, one of them is used", "[connect]") {
  StationRig rig;
  rig.format.on_open();
  for (std::uint64_t s = 0; s < 4; ++s) rig.send(1000 * s, 100);
  for (std::uint64_t s = 4; s < 20; ++s) {
    rig.send(1000 * s, 200);
    rig.send(1000 * s + 500, 300);
  }
  CHECK(rig.epochs.list.size() == 4 + 11);
  CHECK(rig.last_s() == Approx(19.0));
}

TEST_CASE("Corrections of a service make states with a receiver's ephemerides", "[connect]") {
  PublishedCorrections messages;
  MessageOutput output(&messages);
  SharedCorrections shared({}, {}, &output);
  CorrectionOutput corrections("service", &shared);
  GpsClock clock(TimeReference::kGnss, 0.05);
  ReceiverOutput receiver(30.0, &clock, &output, &corrections);
  Rtcm3Format service(GpsTime(), 30.0, &clock, &output, true, &corrections);
  const std::uint64_t of_week_s = kOfWeek_ms / 1000;
  const GpsTime arrival = kTime.plus_seconds(6.0);
  service.feed(orbit_and_clock(of_week_s), host_ns(arrival));
  CHECK(messages.counts.empty());
  CHECK(service.why_no_messages().find("1 without their ephemeris") != std::string::npos);
  receiver.send(elements(76));
  service.feed(orbit_and_clock(of_week_s), host_ns(arrival));
  CHECK(messages.states.empty());
  receiver.send(elements(77));
  service.feed(orbit_and_clock(of_week_s), host_ns(arrival));
  service.feed(code_bias(of_week_s), host_ns(arrival));
  // Observations in a service's stream are not the vehicle's.
  service.feed(msm4(1074, kOfWeek_ms), host_ns(arrival));
  service.finish();
  CHECK(messages.counts[Channel::kGnssEpoch] == 0);
  CHECK(messages.counts[Channel::kEphemeris] == 2);
  CHECK(messages.counts[Channel::kBiases] == 1);
  REQUIRE(messages.states.size() == 1);
  const CorrectedState& state = messages.states.front();
  CHECK(seconds_between(state.time, arrival) == Approx(0.0).margin(1e-6));
  CHECK(state.corrected_at == kTime);
  CHECK(state.issue == 77);
  const SatelliteState broadcast = broadcast_state(elements(77), state.time);
  CHECK((broadcast.p_e - state.p_e).norm() == Approx(1.0));
  CHECK(kSpeedOfLight * (state.clock_s - broadcast.clock_s) == Approx(0.5).margin(1e-6));
  CHECK(service.counts().messages == 1);        // biases do not count
  CHECK(receiver.detail() == "2 ephemerides");  // no word of signals, as there is no epoch
  CHECK(service.data_time()->nanoseconds == kTime.nanoseconds());
}

TEST_CASE("A service that sends the same ephemerides again is alive", "[connect]") {
  Ephemerides ephemerides;
  MessageOutput output(&ephemerides);
  GpsClock clock(TimeReference::kGnss, 0.05);
  SharedCorrections shared({}, {}, &output);
  CorrectionOutput corrections("service", &shared);
  Rtcm3Format service(GpsTime(), 30.0, &clock, &output, true, &corrections);
  for (int k = 1; k <= 3; ++k) {
    service.feed(gps_ephemeris(3), host_ns(kTime.plus_seconds(10.0 * k)));
    CHECK(service.counts().messages == static_cast<std::uint64_t>(k));
  }
  CHECK(ephemerides.list.size() == 1);
}

TEST_CASE("A live service of ephemerides sends them again for who starts later", "[connect]") {
  const bool is_live = GENERATE(true, false);
  Ephemerides ephemerides;
  MessageOutput output(&ephemerides);
  GpsClock clock(TimeReference::kGnss, 0.05);
  SharedCorrections shared({}, {}, &output);
  CorrectionOutput corrections("service", &shared);
  Rtcm3Format service(is_live ? GpsTime() : kTime, 30.0, &clock, &output, true, &corrections);
  const auto feed = [&](std::uint64_t satellite, double s) {
    service.feed(gps_ephemeris(satellite), host_ns(kTime.plus_seconds(s)));
  };
  feed(3, 0.0);
  feed(4, 20.0);
  CHECK(ephemerides.list.size() == 2);
  // Any ephemeris, new or not, is an occasion for those that are due.
  feed(4, 31.0);
  REQUIRE(ephemerides.list.size() == (is_live ? 3 : 2));
  if (is_live) CHECK(ephemerides.list.back().satellite.number == 3);
  feed(3, 51.0);
  REQUIRE(ephemerides.list.size() == (is_live ? 4 : 2));
  CHECK(ephemerides.list.back().satellite.number == 4);
}

TEST_CASE("Corrections that are too old are told with what may be wrong", "[connect]") {
  PublishedCorrections messages;
  MessageOutput output(&messages);
  SharedCorrections shared({}, {}, &output);
  CorrectionOutput corrections("service", &shared);
  GpsClock clock(TimeReference::kGnss, 0.05);
  Rtcm3Format service(GpsTime(), 30.0, &clock, &output, true, &corrections);
  corrections.add(elements(77));
  service.feed(orbit_and_clock(kOfWeek_ms / 1000), host_ns(kTime.plus_seconds(1200.0)));
  CHECK(messages.states.empty());
  const std::string text = service.why_no_messages();
  CHECK_THAT(text, Catch::Contains("1 too old"));
  CHECK_THAT(text, Catch::Contains("is the host's clock right"));
  CHECK_THAT(text, !Catch::Contains("ephemerides must come"));
}

TEST_CASE("The age of corrections by a host's clock that is not synchronised is told",
          "[connect]") {
  PublishedCorrections messages;
  MessageOutput output(&messages);
  SharedCorrections shared({}, {}, &output);
  CorrectionOutput corrections("service", &shared);
  GpsClock clock(TimeReference::kGnss, 0.05, HostClock::wall_ns(), [] { return true; });
  Rtcm3Format service(GpsTime(), 30.0, &clock, &output, true, &corrections);
  service.feed(gps_ephemeris(7), host_ns(kTime.plus_seconds(1200.0)));  // confirms the week
  CHECK_THAT(service.detail(), !Catch::Contains("synchronised"));
  service.feed(orbit_and_clock(kOfWeek_ms / 1000), host_ns(kTime.plus_seconds(1200.0)));
  const std::string sentence =
      "the host's clock is not synchronised, and the age of these corrections is taken from it";
  CHECK_THAT(service.why_no_messages(), Catch::Contains("1 too old"));
  CHECK_THAT(service.why_no_messages(), Catch::Contains(sentence));
  // A receiver's epochs give the age.
  for (int s = 0; s < 30; ++s)
    clock.on_epoch(kTime.plus_seconds(s), host_ns(kTime.plus_seconds(1200.0 + s)));
  REQUIRE(clock.at(host_ns(kTime.plus_seconds(1200.0))));
  CHECK_THAT(service.why_no_messages(), !Catch::Contains(sentence));
}

}  // namespace leonav
