// This unit reads the keys of a stream's source.
#pragma once
#include <string>

#include "daemon/config/config_reader.h"
#include "tools/connect/source_options.h"

namespace leonav {

// Reads the keys of a source in the group of a stream. Paths are relative to `folder`. Throws
// ConfigError, also where a file that an NTRIP source needs cannot be used.
void read_source(ConfigReader& group, const std::string& folder, SourceOptions* source);

}  // namespace leonav
