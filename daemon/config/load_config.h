// These functions load a DaemonConfig from YAML.
//
// Built-in defaults are overridden by a preset (the key `preset`), the preset by the keys of the
// file, and these by the overrides of the command line, key by key.
#pragma once
#include <functional>
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

// Judges what a certain use of a configuration needs beyond good keys. It throws ConfigError, whose
// text joins the other errors. It sees the default of each key whose value cannot be used.
using ConfigCheck = std::function<void(const DaemonConfig&)>;

// A key that is unknown, repeated, of the wrong type or out of range throws ConfigError. Each
// override is "group.key=value", value in YAML, and is judged like the file. Files that the
// configuration names are read here and once; `source` of the result has their contents.
DaemonConfig load_config(const std::string& path, const std::vector<std::string>& overrides = {},
                         const std::vector<ConfigCheck>& checks = {});

// Loads from text; `name` stands for the file in errors.
DaemonConfig load_config_text(const std::string& text, const std::string& name,
                              const std::vector<std::string>& overrides = {},
                              const std::vector<ConfigCheck>& checks = {});

// Loads a preset alone.
DaemonConfig load_preset(const std::string& name, const std::vector<std::string>& overrides = {},
                         const std::vector<ConfigCheck>& checks = {});

// Returns the override that sets `key` to exactly `value`, which YAML might otherwise read as
// another type.
std::string text_override(const std::string& key, const std::string& value);

}  // namespace leonav
