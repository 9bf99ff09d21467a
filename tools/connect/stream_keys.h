// This unit reads the keys of one stream of leonav-connect.
#pragma once
#include <string>

#include "daemon/config/config_reader.h"
#include "tools/connect/connect_config.h"

namespace leonav {

// Reads the group of one stream. Paths are relative to `folder`. Throws ConfigError.
void read_stream(ConfigReader& group, const std::string& folder, StreamConfig* stream);

}  // namespace leonav
