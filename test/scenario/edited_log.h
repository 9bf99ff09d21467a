// A log with its GNSS epochs changed.
#pragma once
#include <string>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/decode.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/event_log.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav::test {

// Writes `log` anew. edit(n, &epoch) changes the n-th epoch, from 1, and tells whether it stays.
template <typename Edit>
std::string edited(const TemporaryFile& place, const std::string& log, Edit edit) {
  const std::string path = place.beside("edited.lcmlog");
  EventLogReader reader(log);
  EventLogWriter writer(path);
  Decoder decoder;
  Encoder encoder;
  RawEpoch epoch;
  const std::string channel = channel_name(Channel::kGnssEpoch);
  LogEvent event;
  bool good = true;
  for (int n = 0; reader.next(&event);) {
    ByteSpan bytes(event.data);
    if (event.channel == channel) {
      const DecodeResult result = decoder.decode(bytes, &epoch);
      good = good && result.fault == InputFault::kNone && result.element_faults == 0;
      if (!edit(++n, &epoch)) continue;
      bytes = encoder.encode(epoch, result.sequence);
    }
    good = writer.write(event.timestamp_us, event.channel, bytes) && good;
  }
  REQUIRE(writer.flush());
  REQUIRE(good);
  return path;
}

}  // namespace leonav::test
