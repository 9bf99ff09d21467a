// These functions read and make the file of broadcast products beside the checkpoint.
//
// The file is an LCM event log of the messages EPHEMERIS, BIASES and IONOSPHERE, so that
// lcm-logplayer and leonav-import can read it; its last event, on the channel CRC32, is the CRC-32
// of all bytes before it.
#pragma once
#include <optional>
#include <string>

#include "daemon/checkpoint/product_store.h"
#include "drivers/lcm/encode.h"

namespace leonav {

// The file of a checkpoint's path.
std::string products_path(const std::string& checkpoint_path);

// Returns nullopt if there is no file. Throws ConfigError, naming the path, where it cannot be read
// or is damaged in any way: half of what it held would be used without a word.
std::optional<BroadcastProducts> load_products(const std::string& path);

// Makes the content of the file, time and again: its memory is taken at construction, and more of
// it only where a content is longer than any before.
class ProductsText {
 public:
  static constexpr std::size_t kUsualBytes = 128 << 10;  // of some 300 satellites; no limit

  ProductsText();

  // Returns the content for these products; valid until the next call.
  const std::string& of(const BroadcastProducts& products);

 private:
  std::string ephemeris_channel_, biases_channel_, ionosphere_channel_;
  Encoder encoder_;
  std::string text_;
};

}  // namespace leonav
