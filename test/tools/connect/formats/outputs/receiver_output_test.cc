// What a receiver tells of its own time.
#include "tools/connect/formats/outputs/receiver_output.h"

#include "support/catch.h"

namespace leonav {
namespace {

struct Nowhere : MessageTarget {
  void take(Channel, ByteSpan) override {}
};

}  // namespace

TEST_CASE("A receiver whose time leaps says so, and one that was off for hours does not",
          "[connect]") {
  Nowhere nowhere;
  MessageOutput output(&nowhere);
  GpsClock clock(TimeReference::kGnss, 0.05);
  ReceiverOutput receiver(0.0, &clock, &output);
  const auto send = [&](double gps_s) {
    RawEpoch epoch;
    epoch.time = GpsTime::from_nanoseconds(0).plus_seconds(gps_s);
    receiver.send(epoch, 0);
  };
  constexpr double kNow_s = 1.3e9;
  for (const double time_s : {kNow_s, kNow_s + 1.0, kNow_s + 7200.0}) send(time_s);
  CHECK_THAT(receiver.detail(), !Catch::Contains("stepped"));
  send(kNow_s - 1e8);
  CHECK_THAT(receiver.detail(), Catch::Contains("stepped 1 times, the last by -100007200 s"));
  send(kNow_s - 1e8 + 1.0);
  send(kNow_s + 7205.0);
  CHECK_THAT(receiver.detail(), Catch::Contains("stepped 2 times, the last by 100007204 s"));
}

TEST_CASE("An epoch without a signal is published and does not count as one with signals",
          "[connect]") {
  Nowhere nowhere;
  MessageOutput output(&nowhere);
  GpsClock clock(TimeReference::kGnss, 0.05);
  ReceiverOutput receiver(0.0, &clock, &output);
  RawEpoch epoch;
  epoch.time = GpsTime::from_nanoseconds(1'300'000'000'000'000'000);
  receiver.send(epoch, 0);
  CHECK(receiver.messages() == 1);
  CHECK(receiver.epochs() == 0);
  CHECK(receiver.empty_epochs() == 1);
  epoch.time = epoch.time.plus_seconds(1.0);
  epoch.observations.emplace_back();
  receiver.send(epoch, 0);
  CHECK(receiver.messages() == 2);
  CHECK(receiver.epochs() == 1);
  CHECK(receiver.empty_epochs() == 1);
}

}  // namespace leonav
