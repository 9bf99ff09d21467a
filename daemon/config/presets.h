// Presets are configurations for common uses, compiled into the program with the reference of all
// keys.
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

// Returns the presets in alphabetical order, generated from config/presets.
std::span<const Preset> presets();

// Returns config/reference.yaml: every key with default, range and meaning.
std::string_view reference_text();

// Returns "car, demo, ...".
std::string preset_names();

// Throws a ConfigError that begins with `where` and lists the presets, if there is none of that
// name.
const Preset& find_preset(const std::string& name, const std::string& where);

// Returns the preset that the key `preset` of these layers names, and those that it builds on,
// lowest precedence first; empty if the key is absent. Throws ConfigError.
std::vector<ConfigLayer> preset_layers(const std::vector<ConfigLayer>& layers);

}  // namespace leonav
