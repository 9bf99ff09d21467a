// A system whose satellites are observed and of which no ephemeris comes is told.
#include "tools/connect/formats/outputs/ephemeris_monitor.h"

#include <initializer_list>

#include "support/catch.h"
#include "tools/connect/formats/outputs/receiver_output.h"

namespace leonav {
namespace {

struct NoTarget : MessageTarget {
  void take(Channel, ByteSpan) override {}
};

const char* remedy_for(System system) {
  return system == System::kBeidou ? "switch on D1" : "switch on the rest";
}

const GpsTime kBegin = GpsTime::from_week_and_tow(2367, 345'600.0);

// So many satellites of each system, with two signals each.
RawEpoch epoch_of(double second, int gps, int galileo, int beidou = 0) {
  RawEpoch epoch;
  epoch.time = kBegin.plus_seconds(second);
  const auto add = [&](System system, int count) {
    for (int number = 1; number <= count; ++number) {
      for (const char band : {'1', '5'}) {
        SignalObservation observation;
        observation.satellite = {system, static_cast<std::uint16_t>(number)};
        observation.code = {band, 'C'};
        epoch.observations.push_back(observation);
      }
    }
  };
  add(System::kGps, gps);
  add(System::kGalileo, galileo);
  add(System::kBeidou, beidou);
  return epoch;
}

Ephemeris ephemeris_of(System system, double toe_s = 0.0) {
  Ephemeris ephemeris;
  ephemeris.satellite = {system, 3};
  ephemeris.toe = kBegin.plus_seconds(toe_s);
  return ephemeris;
}

// Two streams of one program.
struct TwoReceivers {
  NoTarget target;
  MessageOutput output{&target};
  GpsClock clock{TimeReference::kGnss, 0.05};
  ReceiverOutput receiver{0.0, &clock, &output, nullptr, remedy_for};
  ReceiverOutput other{0.0, &clock, &output, nullptr, remedy_for};
};

}  // namespace

TEST_CASE("A system without ephemerides is told after a minute, once, until one comes",
          "[connect]") {
  TwoReceivers rig;
  rig.receiver.send(ephemeris_of(System::kGps));
  rig.receiver.send(epoch_of(0.0, 9, 12), 0);
  rig.receiver.send(epoch_of(59.0, 9, 12), 0);
  CHECK(rig.receiver.take_news().empty());
  CHECK(rig.receiver.detail() == "42 signals in the last epoch, 1 ephemerides");
  rig.receiver.send(epoch_of(60.0, 9, 11), 0);
  const std::string text = "11 Galileo satellites without an ephemeris: switch on the rest";
  CHECK(rig.receiver.take_news() == text);
  CHECK(rig.receiver.take_news().empty());
  CHECK(rig.receiver.detail() == "40 signals in the last epoch, 1 ephemerides; " + text);
  // Not while none of them is in view.
  rig.receiver.send(epoch_of(61.0, 9, 0), 0);
  CHECK_THAT(rig.receiver.detail(), !Catch::Contains("Galileo"));
  rig.receiver.send(epoch_of(62.0, 9, 11), 0);
  CHECK_THAT(rig.receiver.detail(), Catch::Contains(text));
  CHECK(rig.receiver.take_news().empty());
  rig.receiver.send(ephemeris_of(System::kGalileo));
  rig.receiver.send(epoch_of(63.0, 9, 11), 0);
  CHECK_THAT(rig.receiver.detail(), !Catch::Contains("Galileo"));
  CHECK(rig.receiver.take_news().empty());
}

TEST_CASE("Systems with the same remedy share a sentence", "[connect]") {
  TwoReceivers rig;
  rig.receiver.send(epoch_of(0.0, 9, 12, 7), 0);
  rig.receiver.send(epoch_of(60.0, 9, 12, 7), 0);
  CHECK(rig.receiver.take_news() ==
        "9 GPS and 12 Galileo satellites without an ephemeris: switch on the rest; "
        "7 BeiDou satellites without an ephemeris: switch on D1");
}

TEST_CASE("Ephemerides and corrected states of another stream are enough", "[connect]") {
  for (const bool is_state : {false, true}) {
    TwoReceivers rig;
    if (is_state) {
      rig.output.note_orbit({System::kGalileo, 5}, kBegin);
    } else {
      rig.other.send(ephemeris_of(System::kGalileo));
    }
    rig.receiver.send(epoch_of(0.0, 0, 12), 0);
    rig.receiver.send(epoch_of(60.0, 0, 12), 0);
    CHECK(rig.receiver.take_news().empty());
    CHECK_THAT(rig.receiver.detail(), !Catch::Contains("Galileo"));
  }
}

TEST_CASE("Elements for corrections alone are no ephemerides, and old ones none any more",
          "[connect]") {
  TwoReceivers rig;
  Ephemeris cnav1 = ephemeris_of(System::kBeidou);
  cnav1.message = NavigationMessage::kBeidouCnav1;
  rig.receiver.send(cnav1);
  rig.receiver.send(ephemeris_of(System::kGps, -3.99 * 3600.0));
  for (const double second : {0.0, 60.0}) rig.receiver.send(epoch_of(second, 9, 0, 7), 0);
  CHECK(rig.receiver.take_news() == "7 BeiDou satellites without an ephemeris: switch on D1");
  for (const double second : {120.0, 180.0}) rig.receiver.send(epoch_of(second, 9, 0, 7), 0);
  CHECK_THAT(rig.receiver.take_news(), Catch::Contains("9 GPS satellites"));
}

TEST_CASE("A receiver whose time has stepped gets another minute", "[connect]") {
  TwoReceivers rig;
  rig.receiver.send(epoch_of(0.0, 9, 0), 0);
  rig.receiver.send(epoch_of(1e8, 9, 0), 0);
  CHECK(rig.receiver.take_news().empty());
  rig.receiver.send(epoch_of(1e8 + 60.0, 9, 0), 0);
  CHECK_THAT(rig.receiver.take_news(), Catch::Contains("9 GPS satellites"));
}

}  // namespace leonav
