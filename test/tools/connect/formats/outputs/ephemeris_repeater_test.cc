// Ephemerides are sent again, a few at each epoch, as long as they can serve.
#include "tools/connect/formats/outputs/ephemeris_repeater.h"

#include "support/catch.h"

namespace leonav {
namespace {

struct Counter : MessageTarget {
  void take(Channel channel, ByteSpan) override {
    CHECK(channel == Channel::kEphemeris);
    ++count;
  }
  int count = 0;
};

const GpsTime kToe = GpsTime::from_week_and_tow(2136, 345'600.0);

}  // namespace

TEST_CASE("Each ephemeris is sent again after its interval, a few at a time", "[connect]") {
  Counter target;
  MessageOutput output(&target);
  EphemerisRepeater repeater(30.0, &output);
  for (std::uint16_t number = 1; number <= 10; ++number) {
    Ephemeris ephemeris;
    ephemeris.satellite = {System::kGps, number};
    ephemeris.toe = kToe;
    repeater.remember(ephemeris, kToe);
    repeater.remember(ephemeris, kToe);  // the same once more is still one
  }
  const auto at = [&](double s) { return repeater.repeat(kToe.plus_seconds(s)); };
  CHECK(at(29.0) == 0);
  CHECK(at(30.0) == 4);
  CHECK(at(31.0) == 4);
  CHECK(at(32.0) == 2);
  CHECK(at(33.0) == 0);
  CHECK(at(60.0) == 4);
  CHECK(target.count == 14);
  // After four hours they are of no use to anyone.
  CHECK(at(5 * 3600.0) == 0);
  CHECK(at(6 * 3600.0) == 0);
}

TEST_CASE("With an interval of zero nothing is sent again", "[connect]") {
  Counter target;
  MessageOutput output(&target);
  EphemerisRepeater repeater(0.0, &output);
  Ephemeris ephemeris;
  ephemeris.satellite = {System::kGps, 1};
  ephemeris.toe = kToe;
  repeater.remember(ephemeris, kToe);
  CHECK(repeater.repeat(kToe.plus_seconds(3600.0)) == 0);
}

}  // namespace leonav
