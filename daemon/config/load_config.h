// The YAML configuration file -> DaemonConfig.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/config/daemon_config.h"

namespace leonav {

// what() is "FILE:LINE: group.key: what is wrong; what to do". For a value given on the command
// line "--set group.key" stands in place of file and line.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Keys that are absent keep their defaults; a key that is unknown, repeated, of the wrong type or
// out of range throws ConfigError. Each override is "group.key=value", value in YAML, applied to
// the tree before anything is judged, so that it is judged like the file. `absent` (if given)
// receives every known key that the file left at its default. Files that the configuration names
// are read here and once; `source.overrides` of the result holds what they said.
DaemonConfig load_config(const std::string& path, const std::vector<std::string>& overrides = {},
                         std::vector<std::string>* absent = nullptr);

// The override that sets `key` to exactly `value`, which YAML would otherwise read in its own way.
std::string text_override(const std::string& key, const std::string& value);

// The same from text; `name` stands for the file in errors.
DaemonConfig load_config_text(const std::string& text, const std::string& name,
                              const std::vector<std::string>& overrides = {},
                              std::vector<std::string>* absent = nullptr);

}  // namespace leonav
