// These functions write a configuration as YAML text that needs neither presets nor other files.
#pragma once
#include <string>

#include "daemon/config/daemon_config.h"

namespace leonav {

enum class Extent : unsigned char {
  kAllKeys,
  kChanges,  // only keys that differ from their defaults
};

// Returns the effective values, one key a line, with the origin in a comment. A value that follows
// from another key ("default of vehicle.kind") is in the comment too: the key itself is `~` or
// `by_kind`, so that an override of the other key acts. The text loads as the same configuration,
// bit for bit; with kAllKeys even where presets and the defaults of single keys have changed.
std::string effective_text(const ConfigOrigin& source, Extent extent = Extent::kAllKeys);

}  // namespace leonav
