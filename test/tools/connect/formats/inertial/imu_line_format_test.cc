// What leonav-connect publishes of a sensor that writes text, across connections.
#include "tools/connect/formats/inertial/imu_line_format.h"

#include <string>
#include <vector>

#include "drivers/lcm/decode.h"
#include "support/catch.h"

namespace leonav {
namespace {

struct LineSamples : MessageTarget {
  void take(Channel channel, ByteSpan bytes) override {
    REQUIRE(channel == Channel::kImu);
    REQUIRE(Decoder().decode(bytes, &samples.emplace_back()).fault == InputFault::kNone);
  }
  std::vector<ImuSample> samples;
};

}  // namespace

TEST_CASE("Half a line of a connection that has ended is no part of the next one's first sample",
          "[connect]") {
  using enum LineColumn;
  LineLayout layout;
  layout.columns = {kGyroX, kGyroY, kGyroZ, kAccelX, kAccelY, kAccelZ, kGpsWeek, kGpsTowS};
  LineSamples messages;
  MessageOutput output{&messages};
  const GpsClock clock{TimeReference::kHost, 0.0};
  ImuLineFormat format{layout, &clock, ImuStampOptions{}, &output};
  int sent = 0;
  const auto line = [&sent] {
    return "0.0049,0,0,0,0,-9.8,2200," + std::to_string(1000.0 + 0.01 * sent++) + "\n";
  };
  const auto feed = [&format](const std::string& text) {
    format.feed(std::vector<std::uint8_t>(text.begin(), text.end()), 1);
  };
  for (int connection = 0; connection < 3; ++connection) {
    format.on_open();
    for (int k = 0; k < 20; ++k) feed(line());
    feed("3");  // the connection breaks in the middle of a line
  }
  CHECK(messages.samples.size() > 50);
  for (const ImuSample& sample : messages.samples) CHECK(sample.delta_theta_b.x() < 0.0001);
  CHECK(format.counts().frames == 57);
  CHECK(format.counts().damaged == 0);
}

}  // namespace leonav
