// Other protocols between UBX messages: recognised by their own checksums, told apart from damage.
#include "drivers/ubx/foreign_messages.h"

#include <string>

#include "drivers/ubx/walk_recording.h"
#include "support/catch.h"

namespace leonav {
namespace {

// The example of RTCM 10403.1, 4.2: message 1005 with its checksum 360B98.
const std::string kRtcm1005(
    "\xD3\x00\x13\x3E\xD7\xD3\x02\x02\x98\x0E\xDE\xEF\x34\xB4\xBD\x62\xAC\x09\x41\x98\x6F\x33\x36"
    "\x0B\x98",
    25);
const std::string kGga = "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n";

ForeignMessageCounters count(const std::string& stream) {
  ForeignMessages messages;
  for (const char c : stream) messages.take(static_cast<std::uint8_t>(c));
  return messages.counters();
}

}  // namespace

TEST_CASE("Sentences and frames with good checksums count") {
  const auto counters =
      count("noise" + kGga + kRtcm1005 + kGga + "\xD3\x00" + kRtcm1005 + "$GN" + kGga);
  CHECK(counters.nmea_sentences == 3);
  CHECK(counters.nmea_bytes == 3 * kGga.size());
  CHECK(counters.rtcm3_frames >= 1);
  CHECK(counters.rtcm3_bytes == counters.rtcm3_frames * kRtcm1005.size());
}

TEST_CASE("Damage does not count") {
  for (std::size_t i = 0; i < kRtcm1005.size(); ++i) {
    std::string damaged = kRtcm1005;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    CHECK(count(damaged).rtcm3_frames == 0);
  }
  for (std::size_t i = 0; i < kGga.size(); ++i) {
    std::string damaged = kGga;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x01);
    INFO("byte " << i);
    CHECK(count(damaged).nmea_sentences == 0);
  }
  CHECK(count("$" + std::string(100'000, 'A')).bytes() == 0);
  CHECK(count(std::string(100'000, '\xD3')).bytes() == 0);
}

TEST_CASE("A UBX message in between ends a sentence") {
  ForeignMessages messages;
  for (const char c : kGga.substr(0, 20)) messages.take(static_cast<std::uint8_t>(c));
  messages.interrupt();
  for (const char c : kGga.substr(20)) messages.take(static_cast<std::uint8_t>(c));
  CHECK(messages.counters().nmea_sentences == 0);
}

// Counted apart from this code: 536 each of GNRMC, GNGGA and GNGLL, 402 GNTXT; 136,199 bytes.
TEST_CASE("What the walk's receiver sends besides UBX is NMEA and nothing else") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  const UbxFramerCounters counters = test::decode_walk().counters.framer;
  CHECK(counters.foreign.nmea_sentences == 3 * 536 + 402);
  CHECK(counters.foreign.rtcm3_frames == 0);
  CHECK(counters.bytes_skipped == 136'199);
  CHECK(counters.foreign.bytes() == counters.bytes_skipped);
}

}  // namespace leonav
