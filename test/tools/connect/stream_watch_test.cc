// What is told of a stream, second by second.
#include "tools/connect/stream_watch.h"

#include <cmath>

#include "support/catch.h"

namespace leonav {
namespace {

class FakeFormat : public StreamFormat {
 public:
  void feed(std::span<const std::uint8_t>, std::int64_t) override {}
  FormatCounts counts() const override { return now; }
  std::optional<DataTime> data_time() const override { return std::nullopt; }
  std::string detail() const override { return "all is well"; }
  std::string why_no_frames() const override { return "is the baud rate right?"; }
  std::string why_no_messages() const override { return "switch it on"; }
  std::string why_no_samples() const override { return "log RAWIMUSXB"; }
  FormatCounts now;
};

// A stream of which each second brings some bytes, frames and messages.
struct WatchRig {
  void seconds(int count, std::size_t bytes, std::uint64_t frames, std::uint64_t messages) {
    for (int i = 0; i < count; ++i) {
      now_ns += 1'000'000'000;
      if (bytes > 0) watch.on_bytes(bytes, now_ns);
      format.now.frames += frames;
      format.now.messages += messages;
      format.now.epochs += epochs;
      watch.look(now_ns, format);
    }
  }
  StreamWatch watch{WatchLimits{}, "is the sensor on?"};
  FakeFormat format;
  std::uint64_t epochs = 0;  // in each second
  std::int64_t now_ns = 1'000'000'000'000;
};

}  // namespace

TEST_CASE("A stream is good once messages are published, and silent when bytes stop", "[connect]") {
  WatchRig rig;
  CHECK(rig.watch.state() == StreamState::kConnecting);
  rig.watch.on_open(rig.now_ns);
  rig.seconds(2, 0, 0, 0);
  CHECK(rig.watch.state() == StreamState::kConnecting);
  rig.seconds(2, 0, 0, 0);
  CHECK(rig.watch.state() == StreamState::kSilent);
  CHECK_THAT(rig.watch.text(), Catch::Contains("is the sensor on"));
  CHECK(std::isnan(rig.watch.byte_age_s(rig.now_ns)));
  rig.seconds(1, 100, 3, 3);
  CHECK(rig.watch.state() == StreamState::kGood);
  CHECK(rig.watch.text() == "all is well");
  rig.seconds(3, 0, 0, 0);
  CHECK(rig.watch.state() == StreamState::kGood);
  rig.seconds(1, 0, 0, 0);
  CHECK(rig.watch.state() == StreamState::kSilent);
  CHECK(rig.watch.byte_age_s(rig.now_ns) == 4.0);
}

TEST_CASE("Bytes without a whole message are told within seconds, with the remedy", "[connect]") {
  WatchRig rig;
  rig.watch.on_open(rig.now_ns);
  rig.seconds(6, 100, 0, 0);
  CHECK(rig.watch.state() == StreamState::kConnecting);
  rig.seconds(1, 100, 0, 0);
  CHECK(rig.watch.state() == StreamState::kUnreadable);
  CHECK_THAT(rig.watch.text(), Catch::Contains("baud rate"));
  rig.seconds(1, 100, 1, 1);
  CHECK(rig.watch.state() == StreamState::kGood);
  // Also where it was good before.
  rig.seconds(7, 100, 0, 0);
  CHECK(rig.watch.state() == StreamState::kUnreadable);
}

TEST_CASE("Whole messages with nothing to publish are told, with the remedy", "[connect]") {
  WatchRig rig;
  rig.watch.on_open(rig.now_ns);
  rig.seconds(12, 100, 5, 0);
  CHECK(rig.watch.state() == StreamState::kNoData);
  CHECK(rig.watch.text() == "switch it on");
  // A receiver with an epoch every five seconds, and silence in between, is good.
  WatchRig slow;
  slow.watch.on_open(slow.now_ns);
  for (int i = 0; i < 5; ++i) {
    slow.seconds(1, 500, 1, 1);
    CHECK(slow.watch.state() == StreamState::kGood);
    slow.seconds(2, 0, 0, 0);
    CHECK(slow.watch.state() == StreamState::kGood);
  }
}

TEST_CASE("A receiver whose epochs have stopped is told although it sends inertial samples",
          "[connect]") {
  WatchRig rig;
  rig.watch.on_open(rig.now_ns);
  // One that has never sent epochs, such as a stream of ephemerides, is good without them.
  rig.seconds(30, 100, 5, 5);
  CHECK(rig.watch.state() == StreamState::kGood);
  rig.epochs = 1;
  rig.seconds(5, 100, 5, 5);
  rig.epochs = 0;
  rig.seconds(10, 100, 5, 5);
  CHECK(rig.watch.state() == StreamState::kGood);
  rig.seconds(1, 100, 5, 5);
  CHECK(rig.watch.state() == StreamState::kNoData);
  CHECK_THAT(rig.watch.text(), Catch::Contains("no epoch with signals for 11 s"));
  rig.epochs = 1;
  rig.seconds(1, 100, 5, 5);
  CHECK(rig.watch.state() == StreamState::kGood);
  // Silence is told as silence, and then the epochs have their time again.
  rig.epochs = 0;
  rig.seconds(20, 0, 0, 0);
  CHECK(rig.watch.state() == StreamState::kSilent);
  rig.seconds(10, 100, 5, 5);
  CHECK(rig.watch.state() == StreamState::kGood);
  rig.seconds(2, 100, 5, 5);
  CHECK(rig.watch.state() == StreamState::kNoData);
  rig.watch.on_open(rig.now_ns);
  rig.seconds(10, 100, 5, 5);
  CHECK(rig.watch.state() == StreamState::kGood);
}

TEST_CASE("Samples that are asked for and do not come are told although epochs come", "[connect]") {
  const bool had_samples = GENERATE(true, false);
  WatchRig rig;
  rig.format.now.samples = 0;
  rig.epochs = 1;
  rig.watch.on_open(rig.now_ns);
  // Samples are awaited from the first whole message on.
  if (had_samples) {
    for (int i = 0; i < 20; ++i) {
      ++*rig.format.now.samples;
      rig.seconds(1, 100, 5, 5);
    }
    rig.seconds(10, 100, 5, 5);
  } else {
    rig.seconds(11, 100, 5, 5);
  }
  CHECK(rig.watch.state() == StreamState::kGood);
  rig.seconds(1, 100, 5, 5);
  CHECK(rig.watch.state() == StreamState::kNoData);
  CHECK(rig.watch.text() == "no inertial sample for 11 s: log RAWIMUSXB");
  ++*rig.format.now.samples;
  rig.seconds(1, 100, 5, 5);
  CHECK(rig.watch.state() == StreamState::kGood);
}

TEST_CASE("Where no message has been whole yet, damage is not told before its cause", "[connect]") {
  WatchRig rig;
  rig.watch.on_open(rig.now_ns);
  for (int i = 0; i < 6; ++i) {
    rig.format.now.damaged += 10;
    rig.seconds(1, 100, 0, 0);
    CHECK(rig.watch.state() == StreamState::kConnecting);
  }
  rig.format.now.damaged += 10;
  rig.seconds(1, 100, 0, 0);
  CHECK(rig.watch.state() == StreamState::kUnreadable);
}

TEST_CASE("A receiver whose antenna is cut is told, since its start or later", "[connect]") {
  const bool had_signals = GENERATE(true, false);
  WatchRig rig;
  rig.watch.on_open(rig.now_ns);
  rig.epochs = 1;
  if (had_signals) rig.seconds(5, 100, 1, 1);
  rig.epochs = 0;
  for (int i = 0; i < 12; ++i) {
    ++rig.format.now.empty_epochs;
    rig.seconds(1, 100, 1, 1);
  }
  CHECK(rig.watch.state() == StreamState::kNoData);
  CHECK_THAT(rig.watch.text(), Catch::Contains("no epoch with signals"));
}

TEST_CASE("A receiver with an epoch each 20 s is good in between, and told after a minute",
          "[connect]") {
  // The messages between are published, or are of other kinds.
  const std::uint64_t published = GENERATE(0, 1);
  WatchRig rig;
  rig.watch.on_open(rig.now_ns);
  const auto epoch = [&] {
    rig.epochs = 1;
    rig.seconds(1, 500, 2, 2);
    rig.epochs = 0;
  };
  // The interval is known from the second epoch on.
  epoch();
  rig.seconds(19, 100, 5, published);
  epoch();
  for (int k = 0; k < 10; ++k) {
    for (int i = 0; i < 19; ++i) {
      rig.seconds(1, 100, 5, published);
      CHECK(rig.watch.state() == StreamState::kGood);
    }
    epoch();
  }
  rig.seconds(59, 100, 5, published);
  CHECK(rig.watch.state() == StreamState::kGood);
  rig.seconds(2, 100, 5, published);
  CHECK(rig.watch.state() == StreamState::kNoData);
}

TEST_CASE("A long pause does not make a later stop of the epochs be told late", "[connect]") {
  WatchRig rig;
  rig.watch.on_open(rig.now_ns);
  rig.epochs = 1;
  rig.seconds(5, 100, 5, 5);
  rig.epochs = 0;
  rig.seconds(600, 100, 5, 5);
  rig.epochs = 1;
  rig.seconds(5, 100, 5, 5);
  rig.epochs = 0;
  rig.seconds(10, 100, 5, 5);
  CHECK(rig.watch.state() == StreamState::kGood);
  rig.seconds(1, 100, 5, 5);
  CHECK(rig.watch.state() == StreamState::kNoData);
}

TEST_CASE("Failures and the end keep their reason", "[connect]") {
  WatchRig rig;
  rig.watch.on_failure("there is no such device", 4.0, rig.now_ns);
  CHECK(rig.watch.text() == "there is no such device; tried again in 4 s");
  rig.seconds(20, 0, 0, 0);
  CHECK(rig.watch.state() == StreamState::kWaiting);
  CHECK(rig.watch.text() == "there is no such device; being tried again");
  CHECK(rig.watch.failures() == 1);
  CHECK(rig.watch.silence_s(rig.now_ns) == 0.0);
  rig.watch.on_open(rig.now_ns);
  rig.watch.on_end("");
  CHECK(rig.watch.state() == StreamState::kEnded);
  CHECK(rig.watch.failures() == 1);
}

TEST_CASE("Damage of more than a tenth of all messages is told until it is below half of that",
          "[connect]") {
  WatchRig rig;
  rig.watch.on_open(rig.now_ns);
  const auto seconds = [&](int count, std::uint64_t damaged, std::uint64_t messages) {
    for (int i = 0; i < count; ++i) {
      rig.format.now.damaged += damaged;
      rig.seconds(1, 100, 10, messages);
    }
  };
  seconds(20, 0, 1);
  seconds(5, 2, 1);  // 10 of 110 messages
  CHECK(rig.watch.state() == StreamState::kGood);
  seconds(3, 2, 1);
  CHECK(rig.watch.state() == StreamState::kDamaged);
  CHECK_THAT(rig.watch.text(), Catch::Contains("16 of the last 116 messages were damaged"));
  seconds(15, 1, 1);  // 10 of 110
  CHECK(rig.watch.state() == StreamState::kDamaged);
  seconds(6, 0, 1);  // 4 of 104
  CHECK(rig.watch.state() == StreamState::kGood);
  rig.format.now.damaged += 5;
  rig.seconds(7, 100, 0, 0);
  CHECK(rig.watch.state() == StreamState::kUnreadable);
  CHECK_THAT(rig.watch.text(),
             Catch::Contains("baud rate right?; 5 of the last") && Catch::Contains("is the cable"));
  seconds(11, 0, 1);
  CHECK(rig.watch.state() == StreamState::kGood);
  // Where damage leaves only other messages whole, it is told and not a missing message.
  seconds(12, 4, 0);
  CHECK(rig.watch.state() == StreamState::kNoData);
  CHECK_THAT(rig.watch.text(), Catch::Contains("were damaged"));
  seconds(12, 0, 0);
  CHECK_THAT(rig.watch.text(), Catch::Contains("switch it on"));
}

}  // namespace leonav
