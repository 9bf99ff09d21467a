#include "daemon/engine/saved_inputs.h"

#include <spdlog/spdlog.h>

#include <span>

#include "daemon/checkpoint/checkpoint_file.h"
#include "daemon/checkpoint/products_file.h"
#include "daemon/config/load_config.h"
#include "daemon/threads/wall_clock.h"
#include "drivers/lcm/encode.h"

namespace leonav {
namespace {

void begin_from_products(const std::string& path, Engine* engine) {
  try {
    const auto products = load_products(path);
    if (!products) return;
    receive_saved(*products, engine);
    spdlog::info("{}: {} ephemerides and {} biases of signals read", path,
                 products->ephemerides.size(), products->biases.size());
  } catch (const ConfigError& error) {
    spdlog::warn("broadcast products ignored: {}", error.what());
  }
}

}  // namespace

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

void begin_from_saved(const std::string& checkpoint_path, Engine* engine) {
  if (checkpoint_path.empty()) return;
  begin_from_products(products_path(checkpoint_path), engine);
  try {
    const auto checkpoint = load_checkpoint(checkpoint_path);
    if (!checkpoint) return spdlog::info("no checkpoint {} to begin from", checkpoint_path);
    receive_saved(*checkpoint, engine);
    spdlog::info("checkpoint {} read", checkpoint_path);
  } catch (const ConfigError& error) {
    spdlog::warn("checkpoint ignored: {}", error.what());
  }
}

}  // namespace leonav
