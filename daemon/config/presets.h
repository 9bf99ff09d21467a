// Configurations for common uses, and the reference of all keys, compiled into the program.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/config_reader.h"

namespace leonav {

struct Preset {
  std::string_view name;  // of config/presets/NAME.yaml
  std::string_view text;  // its content
};

// In alphabetical order. Generated from config/presets.
std::span<const Preset> presets();

// The content of config/reference.yaml: every key with its default, its range and its meaning.
std::string_view reference_text();

// "car, demo, ...".
std::string preset_names();

// Throws ConfigError, beginning with `where` and listing the presets, if there is none of that
// name.
const Preset& find_preset(const std::string& name, const std::string& where);

// The preset that the key `preset` of these layers names and those that it builds on, lowest
// precedence first; empty where the key is absent. Throws ConfigError.
std::vector<ConfigLayer> preset_layers(const std::vector<ConfigLayer>& layers);

}  // namespace leonav
