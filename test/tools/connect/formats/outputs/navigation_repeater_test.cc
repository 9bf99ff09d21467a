// What came in navigation messages is sent again, a few at each epoch, as long as it can serve.
#include "tools/connect/formats/outputs/navigation_repeater.h"

#include <map>
#include <set>

#include "drivers/lcm/decode.h"
#include "support/catch.h"
#include "tools/connect/formats/outputs/receiver_output.h"

namespace leonav {
namespace {

// Counts messages by their channel, and looks into those of biases and ephemerides.
struct Repeated : MessageTarget {
  void take(Channel channel, ByteSpan bytes) override {
    ++count[channel];
    Decoder decoder;
    if (channel == Channel::kBiases) {
      REQUIRE(decoder.decode(bytes, &biases).fault == InputFault::kNone);
    } else if (channel == Channel::kEphemeris) {
      Ephemeris ephemeris;
      REQUIRE(decoder.decode(bytes, &ephemeris).fault == InputFault::kNone);
      satellites.insert(ephemeris.satellite);
    } else if (channel == Channel::kIonosphere) {
      REQUIRE(decoder.decode(bytes, &ionosphere).fault == InputFault::kNone);
    }
  }
  std::map<Channel, int> count;
  std::set<SatelliteId> satellites;
  SignalBiases biases;
  KlobucharModel ionosphere;
};

const GpsTime kToe = GpsTime::from_week_and_tow(2136, 345'600.0);

Ephemeris ephemeris_of(std::uint16_t number) {
  Ephemeris ephemeris;
  ephemeris.satellite = {System::kGps, number};
  ephemeris.toe = ephemeris.toc = ephemeris.transmission_time = kToe;
  ephemeris.sqrt_a = 5153.7;
  ephemeris.i0 = 0.96;
  return ephemeris;
}

SignalBias delay_of(const char* code, double metres, double received_s = 0.0) {
  SignalBias bias;
  bias.satellite = {System::kBeidou, 23};
  bias.code = {code[0], code[1]};
  bias.kind = BiasKind::kBroadcastCode;
  bias.time = kToe.plus_seconds(received_s);
  bias.bias_m = metres;
  return bias;
}

struct RepeaterRig {
  explicit RepeaterRig(double interval_s) : repeater(interval_s, &output) {}
  int at(double s) { return repeater.repeat(kToe.plus_seconds(s)); }
  Repeated target;
  MessageOutput output{&target};
  NavigationRepeater repeater;
};

}  // namespace

TEST_CASE("Each ephemeris is sent again after its interval, a few at a time", "[connect]") {
  RepeaterRig rig(30.0);
  for (std::uint16_t number = 1; number <= 10; ++number) {
    rig.repeater.remember(ephemeris_of(number), kToe);
    rig.repeater.remember(ephemeris_of(number), kToe);  // the same once more is still one
  }
  CHECK(rig.at(29.0) == 0);
  CHECK(rig.at(30.0) == 4);
  CHECK(rig.at(31.0) == 4);
  CHECK(rig.at(32.0) == 2);
  CHECK(rig.at(33.0) == 0);
  CHECK(rig.at(60.0) == 4);
  CHECK(rig.target.count[Channel::kEphemeris] == 14);
}

TEST_CASE("An ephemeris is sent again as long as leonavd uses one of its system", "[connect]") {
  const auto [system, message, limit_s] = GENERATE(table<System, NavigationMessage, double>(
      {{System::kGps, NavigationMessage::kGpsLnav, 7200.0},
       {System::kGalileo, NavigationMessage::kGalileoInav, 14'400.0},
       {System::kBeidou, NavigationMessage::kBeidouD1, 21'600.0}}));
  RepeaterRig rig(30.0);
  Ephemeris ephemeris = ephemeris_of(3);
  ephemeris.satellite.system = system;
  ephemeris.message = message;
  rig.repeater.remember(ephemeris, kToe);
  CHECK(rig.at(limit_s - 1.0) == 1);
  CHECK(rig.at(limit_s + 100.0) == 0);
  // The next issue takes its place.
  ephemeris.toe = kToe.plus_seconds(limit_s);
  rig.repeater.remember(ephemeris, kToe.plus_seconds(limit_s));
  CHECK(rig.at(limit_s + 100.0) == 1);
}

TEST_CASE("An epoch of another time takes nothing away", "[connect]") {
  RepeaterRig rig(30.0);
  rig.repeater.remember(ephemeris_of(1), kToe);
  rig.repeater.remember({delay_of("5P", 1.0)}, kToe);
  for (const double wild_s : {-9e8, 86'400.0, 9e8}) CHECK(rig.at(wild_s) == 0);
  CHECK(rig.at(30.0) == 2);
}

TEST_CASE("Epochs that are rare bring every ephemeris in turn", "[connect]") {
  RepeaterRig rig(30.0);
  for (std::uint16_t number = 1; number <= 10; ++number) {
    rig.repeater.remember(ephemeris_of(number), kToe);
  }
  for (const double s : {30.0, 60.0, 90.0}) CHECK(rig.at(s) == 4);
  CHECK(rig.target.satellites.size() == 10);
}

TEST_CASE("The ionosphere is sent again, the newest one, as long as epochs come", "[connect]") {
  RepeaterRig rig(30.0);
  KlobucharModel model;
  model.valid = true;
  model.alpha[0] = 1e-8;
  rig.repeater.remember(model, kToe);
  model.alpha[0] = 2e-8;
  rig.repeater.remember(model, kToe.plus_seconds(1.0));
  CHECK(rig.at(30.0) == 0);
  CHECK(rig.at(31.0) == 1);
  CHECK(rig.target.count[Channel::kIonosphere] == 1);
  CHECK(rig.target.ionosphere.alpha[0] == 2e-8);
  CHECK(rig.at(86'400.0) == 1);
}

TEST_CASE("Of a satellite's group delays the newest of each signal are sent again", "[connect]") {
  RepeaterRig rig(30.0);
  rig.repeater.remember({delay_of("5P", 1.0), delay_of("1D", 2.0)}, kToe);
  rig.repeater.remember({delay_of("5P", 3.0, 1800.0), delay_of("5D", 4.0, 1800.0)}, kToe);
  CHECK(rig.at(30.0) == 1);
  std::map<std::string, double> sent;
  for (const SignalBias& bias : rig.target.biases) sent[to_string(bias.code)] = bias.bias_m;
  CHECK(sent == std::map<std::string, double>{{"5P", 3.0}, {"1D", 2.0}, {"5D", 4.0}});
  CHECK(rig.target.biases.front().time == kToe);
  // Four hours after one was received it is sent no more.
  CHECK(rig.at(4 * 3600.0 + 900.0) == 1);
  CHECK(rig.target.biases.size() == 2);
  CHECK(rig.at(5 * 3600.0) == 0);
}

TEST_CASE("A receiver's ionosphere and delays reach a service that starts later", "[connect]") {
  Repeated target;
  MessageOutput output(&target);
  GpsClock clock(TimeReference::kGnss, 0.05);
  ReceiverOutput receiver(30.0, &clock, &output);
  RawEpoch epoch;
  epoch.time = kToe;
  receiver.send(epoch, 0);
  KlobucharModel model;
  model.valid = true;
  receiver.send(model, kToe);
  receiver.send(std::vector<SignalBias>{delay_of("5P", 1.0)});
  for (const double s : {1.0, 30.0}) {
    epoch.time = kToe.plus_seconds(s);
    receiver.send(epoch, 0);
  }
  CHECK(target.count[Channel::kIonosphere] == 2);
  CHECK(target.count[Channel::kBiases] == 2);
}

TEST_CASE("With an interval of zero nothing is sent again", "[connect]") {
  RepeaterRig rig(0.0);
  rig.repeater.remember(ephemeris_of(1), kToe);
  rig.repeater.remember(KlobucharModel(), kToe);
  rig.repeater.remember({delay_of("5P", 1.0)}, kToe);
  CHECK(rig.at(3600.0) == 0);
}

}  // namespace leonav
