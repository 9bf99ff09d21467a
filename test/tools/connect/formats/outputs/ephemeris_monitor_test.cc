// A system whose satellites are observed and of which no ephemeris comes is told.
#include "tools/connect/formats/outputs/ephemeris_monitor.h"

#include <string>

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
  // An epoch every half a minute, from `begin` to `end`.
  void observe(double begin_s, double end_s, int gps, int galileo, int beidou = 0) {
    for (double s = begin_s; s <= end_s; s += 30.0) {
      receiver.send(epoch_of(s, gps, galileo, beidou), 0);
    }
  }
  NoTarget target;
  MessageOutput output{&target};
  GpsClock clock{TimeReference::kGnss, 0.05};
  ReceiverOutput receiver{0.0, &clock, &output, nullptr, remedy_for};
  ReceiverOutput other{0.0, &clock, &output, nullptr, remedy_for};
};

const std::string kOthers =
    " (unless another program sends their orbits: warn_without_ephemerides)";

}  // namespace

TEST_CASE("A system without ephemerides is told after its patience, once, until one comes",
          "[connect]") {
  TwoReceivers rig;
  rig.receiver.send(ephemeris_of(System::kGps));
  rig.observe(0.0, 120.0, 9, 12);
  rig.receiver.send(epoch_of(149.0, 9, 12), 0);
  CHECK(rig.receiver.take_news().empty());
  CHECK(rig.receiver.detail() == "42 signals in the last epoch, 1 ephemerides");
  rig.receiver.send(epoch_of(150.0, 9, 11), 0);
  const std::string text =
      "11 Galileo satellites without an ephemeris: switch on the rest" + kOthers;
  CHECK(rig.receiver.take_news() == text);
  CHECK(rig.receiver.take_news().empty());
  CHECK(rig.receiver.detail() == "40 signals in the last epoch, 1 ephemerides; " + text);
  // Not while none of them is in view.
  rig.receiver.send(epoch_of(151.0, 9, 0), 0);
  CHECK_THAT(rig.receiver.detail(), !Catch::Contains("Galileo"));
  rig.receiver.send(epoch_of(152.0, 9, 11), 0);
  CHECK_THAT(rig.receiver.detail(), Catch::Contains(text));
  CHECK(rig.receiver.take_news().empty());
  rig.receiver.send(ephemeris_of(System::kGalileo));
  rig.receiver.send(epoch_of(153.0, 9, 11), 0);
  CHECK_THAT(rig.receiver.detail(), !Catch::Contains("Galileo"));
  CHECK(rig.receiver.take_news().empty());
}

TEST_CASE("Systems with the same remedy share a sentence", "[connect]") {
  TwoReceivers rig;
  rig.observe(0.0, 150.0, 9, 12, 7);
  CHECK(rig.receiver.take_news() ==
        "9 GPS and 12 Galileo satellites without an ephemeris: switch on the rest; "
        "7 BeiDou satellites without an ephemeris: switch on D1" +
            kOthers);
}

TEST_CASE("Ephemerides and corrected states of another stream are enough", "[connect]") {
  for (const bool is_state : {false, true}) {
    TwoReceivers rig;
    if (is_state) {
      rig.output.note_orbit({System::kGalileo, 5}, kBegin);
    } else {
      rig.other.send(ephemeris_of(System::kGalileo));
    }
    rig.observe(0.0, 150.0, 0, 12);
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
  rig.receiver.send(ephemeris_of(System::kGps, -7000.0));
  rig.observe(0.0, 150.0, 9, 0, 7);
  CHECK(rig.receiver.take_news() ==
        "7 BeiDou satellites without an ephemeris: switch on D1" + kOthers);
  rig.observe(180.0, 390.0, 9, 0, 7);
  CHECK_THAT(rig.receiver.take_news(), Catch::Contains("9 GPS satellites"));
}

TEST_CASE("A receiver whose time has stepped is waited for anew", "[connect]") {
  TwoReceivers rig;
  rig.observe(0.0, 120.0, 9, 0);
  // Back by a minute.
  rig.observe(60.0, 180.0, 9, 0);
  CHECK(rig.receiver.take_news().empty());
  rig.observe(210.0, 210.0, 9, 0);
  CHECK_THAT(rig.receiver.take_news(), Catch::Contains("9 GPS satellites"));
}

TEST_CASE("A pause without satellites, or without epochs, does not count as waiting", "[connect]") {
  const bool has_epochs = GENERATE(true, false);
  TwoReceivers rig;
  rig.observe(0.0, 90.0, 9, 12);
  if (has_epochs) rig.observe(120.0, 690.0, 0, 0);
  // As after a garage: every satellite has to send its ephemeris first.
  rig.observe(720.0, 840.0, 9, 12);
  CHECK(rig.receiver.take_news().empty());
  rig.observe(870.0, 870.0, 9, 12);
  CHECK_THAT(rig.receiver.take_news(), Catch::Contains("9 GPS and 12 Galileo satellites"));
}

TEST_CASE("Satellites that come and go are waited for while they are observed", "[connect]") {
  TwoReceivers rig;
  for (int k = 0; k <= 150; ++k) {
    rig.receiver.send(epoch_of(2.0 * k, 9, 0), 0);
    rig.receiver.send(epoch_of(2.0 * k + 1.0, k % 2 == 0 ? 9 : 0, 0), 0);
    if (k < 140) CHECK(rig.receiver.take_news().empty());
  }
  CHECK_THAT(rig.receiver.take_news(), Catch::Contains("9 GPS satellites"));
}

TEST_CASE("A system whose orbits another program sends is not told", "[connect]") {
  TwoReceivers rig;
  ExpectedOrbits expected = expected_by_default();
  expected[index_of(System::kGalileo)] = false;
  rig.output.expect_orbits(expected);
  rig.observe(0.0, 300.0, 9, 12);
  CHECK_THAT(rig.receiver.take_news(), Catch::StartsWith("9 GPS satellites"));
  rig.output.expect_orbits({});
  rig.observe(330.0, 600.0, 9, 12);
  CHECK(rig.receiver.take_news().empty());
  CHECK_THAT(rig.receiver.detail(), !Catch::Contains("without an ephemeris"));
}

TEST_CASE("An orbit is known for as long as leonavd uses one of its system", "[connect]") {
  const auto [system, limit_s] = GENERATE(table<System, double>(
      {{System::kGps, 7200.0}, {System::kGalileo, 14'400.0}, {System::kBeidou, 21'600.0}}));
  KnownOrbits orbits;
  orbits.note({system, 3}, kBegin);
  for (const double sign : {-1.0, 1.0}) {
    CHECK(orbits.has_any(system, kBegin.plus_seconds(sign * (limit_s - 1.0))));
    CHECK_FALSE(orbits.has_any(system, kBegin.plus_seconds(sign * (limit_s + 1.0))));
  }
}

}  // namespace leonav
