#include "daemon/engine/saved_inputs.h"

#include <spdlog/spdlog.h>

#include <optional>
#include <span>

#include "daemon/checkpoint/checkpoint_file.h"
#include "daemon/checkpoint/products_file.h"
#include "daemon/threads/disk_reading.h"
#include "daemon/threads/wall_clock.h"
#include "drivers/lcm/encode.h"

namespace leonav {
namespace {

// What a file holds, or why it cannot be used; neither: there is no file.
template <typename Content>
struct SavedFile {
  std::optional<Content> content;
  std::string problem;
};

struct SavedFiles {
  SavedFile<BroadcastProducts> products;
  SavedFile<Checkpoint> checkpoint;
};

template <typename Load>
auto read_file_of(Load load, const std::string& path) {
  SavedFile<typename decltype(load(path))::value_type> file;
  try {
    file.content = load(path);
  } catch (const std::exception& error) {
    file.problem = error.what();
  }
  return file;
}

void begin_from_products(const std::string& path, const SavedFile<BroadcastProducts>& file,
                         Engine* engine) {
  if (!file.problem.empty()) spdlog::warn("broadcast products ignored: {}", file.problem);
  if (!file.content) return;
  receive_saved(*file.content, engine);
  spdlog::info("{}: {} ephemerides and {} biases of signals read", path,
               file.content->ephemerides.size(), file.content->biases.size());
}

void begin_from_checkpoint(const std::string& path, const SavedFile<Checkpoint>& file,
                           Engine* engine) {
  if (!file.problem.empty()) {
    engine->counters().checkpoints_ignored.add(1);
    return spdlog::warn("checkpoint ignored: {}", file.problem);
  }
  if (!file.content) return spdlog::info("no checkpoint {} to begin from", path);
  receive_saved(*file.content, engine);
  spdlog::info("checkpoint {} read", path);
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

void begin_from_saved(const std::string& checkpoint_path, Engine* engine,
                      const CheckpointHook& before_read) {
  if (checkpoint_path.empty()) return;
  DiskReading<SavedFiles> reading([path = checkpoint_path, before_read] {
    if (before_read) before_read();
    SavedFiles read;
    read.products = read_file_of(load_products, products_path(path));
    read.checkpoint = read_file_of(load_checkpoint, path);
    return read;
  });
  reading.begin();
  const auto files = reading.wait(kLongestSavedReading_s);
  if (!files) {
    engine->counters().checkpoints_ignored.add(1);
    return spdlog::warn(
        "checkpoint and broadcast products ignored: {}: the disk does not answer within {:g} s",
        checkpoint_path, kLongestSavedReading_s);
  }
  begin_from_products(products_path(checkpoint_path), files->products, engine);
  begin_from_checkpoint(checkpoint_path, files->checkpoint, engine);
}

}  // namespace leonav
