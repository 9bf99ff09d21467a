#include "daemon/engine/saved_inputs.h"

#include <span>

#include "daemon/threads/wall_clock.h"
#include "drivers/lcm/encode.h"

namespace leonav {

void receive_saved(const BroadcastProducts& products, Engine* engine) {
  Encoder encoder;
  // Without numbers, which belong to the senders.
  for (const Ephemeris& ephemeris : products.ephemerides)
    engine->receive(Channel::kEphemeris, encoder.encode(ephemeris, 0), wall_clock_us());
  for (std::span<const SignalBias> rest = products.biases; !rest.empty();) {
    const std::span<const SignalBias> message = first_message_of(rest);
    engine->receive(Channel::kBiases, encoder.encode(message, 0), wall_clock_us());
    rest = rest.subspan(message.size());
  }
  if (products.ionosphere) {
    const ByteSpan bytes = encoder.encode(*products.ionosphere, GpsTime(), 0);
    engine->receive(Channel::kIonosphere, bytes, wall_clock_us());
  }
}

void receive_saved(const Checkpoint& checkpoint, Engine* engine) {
  Encoder encoder;
  engine->receive(Channel::kCheckpoint, encoder.encode(checkpoint, 1), wall_clock_us());
}

}  // namespace leonav
