// These functions read YAML text and the overrides of a command line as one tree of groups.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "daemon/config/config_reader.h"

namespace leonav {

// Throws ConfigError, naming the path and the cause.
std::string read_config_file(const std::string& path);

// Throws ConfigError where the text is no YAML, empty, or not a map of groups.
ConfigLayer text_layer(const std::string& text, const std::string& name);

// Each override is "group.key=value", the value in YAML. Throws ConfigError.
ConfigLayer override_layer(const std::vector<std::string>& overrides);

// Reads the layers as one tree; a later layer takes precedence, key by key. `read` gets the root
// and takes the keys it names; whatever is left over throws. Throws ConfigError with file, line and
// key.
void read_layers(const std::vector<ConfigLayer>& layers, ConfigSource* source,
                 const std::function<void(ConfigReader&)>& read);

// Does the same with one text and overrides.
void read_yaml(const std::string& text, const std::vector<std::string>& overrides,
               ConfigSource* source, const std::function<void(ConfigReader&)>& read);

}  // namespace leonav
