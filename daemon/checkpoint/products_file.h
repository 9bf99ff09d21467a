// These functions read and make the file of broadcast products beside the checkpoint.
//
// The file is an LCM event log of the messages EPHEMERIS and IONOSPHERE, so that lcm-logplayer and
// leonav-import can read it; its last event, on the channel CRC32, is the CRC-32 of all bytes
// before it.
#pragma once
#include <optional>
#include <string>

#include "daemon/checkpoint/product_store.h"

namespace leonav {

// The file of a checkpoint's path.
std::string products_path(const std::string& checkpoint_path);

// Returns nullopt if there is no file. Throws ConfigError, naming the path, where it cannot be read
// or is damaged in any way: half of what it held would be used without a word.
std::optional<BroadcastProducts> load_products(const std::string& path);

// Returns the content of the file for these products.
std::string products_text(const BroadcastProducts& products);

}  // namespace leonav
