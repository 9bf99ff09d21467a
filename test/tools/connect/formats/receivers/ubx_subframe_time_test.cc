// Which time the subframes of a u-blox receiver get that has stopped to send its measurements.
#include <algorithm>
#include <vector>

#include "drivers/ubx/walk_recording.h"
#include "support/catch.h"
#include "tools/connect/formats/receivers/ubx_format.h"

namespace leonav {
namespace {

struct CountedEphemerides : MessageTarget {
  void take(Channel channel, ByteSpan) override { ephemerides += channel == Channel::kEphemeris; }
  int ephemerides = 0;
};

// The walk's first epoch at 1 s, and its subframes without any other message at `arrival_s`.
// Returns how many ephemerides are published.
int ephemerides_at(std::int64_t arrival_s) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  CountedEphemerides messages;
  MessageOutput output{&messages};
  GpsClock clock{TimeReference::kGnss, 0.05};
  UbxFormat format{0.05, 1e9, &clock, &output};
  const auto bytes = test::read_bytes(test::shared_data(test::kWalkUbx));
  bool has_epoch = false;
  for (std::size_t at = 0; at + 8 <= bytes.size();) {
    const std::size_t size = bytes[at + 4] + 256U * bytes[at + 5] + 8;
    if (bytes[at] != 0xB5 || bytes[at + 1] != 0x62 || at + size > bytes.size()) {
      ++at;
      continue;
    }
    const auto message = std::span(bytes).subspan(at, size);
    const bool is_rawx = message[2] == 0x02 && message[3] == 0x15;
    const bool is_sfrbx = message[2] == 0x02 && message[3] == 0x13;
    if (is_rawx && !has_epoch) format.feed(message, kSecond_ns);
    has_epoch = has_epoch || is_rawx;
    if (is_sfrbx && has_epoch) format.feed(message, arrival_s * kSecond_ns);
    at += size;
  }
  return messages.ephemerides;
}

}  // namespace

TEST_CASE("Subframes get the time of an epoch that arrived at most a minute ago", "[connect]") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  CHECK(ephemerides_at(1) > 10);
  CHECK(ephemerides_at(60) == ephemerides_at(1));
  CHECK(ephemerides_at(62) == 0);
}

}  // namespace leonav
