// A configuration as YAML text that needs neither presets nor other files.
#pragma once
#include <string>

#include "daemon/config/daemon_config.h"

namespace leonav {

enum class Extent : unsigned char {
  kAllKeys,
  kChanges,  // only keys that differ from their defaults
};

// The effective values, one key a line with its origin in a comment. The text loads as the same
// configuration, bit for bit; with all keys also under other presets and other defaults.
std::string effective_text(const ConfigOrigin& source, Extent extent = Extent::kAllKeys);

// Every key at its default, with its allowed values in a comment: config/reference.yaml without its
// explanations.
std::string reference_keys();

}  // namespace leonav
