// This function says how long a message of an input's channel may be.
#pragma once
#include <cstdint>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/wire.h"

namespace leonav {

// Bytes; each type of lcmtypes/ at full capacity is shorter, and nothing longer is an input.
constexpr std::uint32_t most_message_bytes(Channel channel) {
  constexpr std::uint32_t kKilobyte = 1024;
  switch (channel) {
    case Channel::kImu:
    case Channel::kEphemeris:
    case Channel::kIonosphere:
    case Channel::kCommand:
    case Channel::kOdometer:
      return wire::kMaxBytesWithoutList;
    case Channel::kAntenna:
      return 8 * kKilobyte;
    case Channel::kCorrectedStates:
      return 16 * kKilobyte;
    case Channel::kGnssEpoch:
    case Channel::kOrbitClock:
      return 24 * kKilobyte;
    default:
      return wire::kMaxMessageBytes;
  }
}

}  // namespace leonav
