// YAML text and the overrides of a command line, read as one tree of groups.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "daemon/config/config_reader.h"

namespace leonav {

// Throws ConfigError, naming the path and the cause.
std::string read_config_file(const std::string& path);

// Each override is "group.key=value", applied before anything is judged. `read` gets the root and
// takes what it knows; whatever is left over throws. Throws ConfigError with file, line and key.
void read_yaml(const std::string& text, const std::vector<std::string>& overrides,
               ConfigSource* source, const std::function<void(ConfigReader&)>& read);

}  // namespace leonav
