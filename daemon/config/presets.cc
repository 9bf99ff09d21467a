#include "daemon/config/presets.h"

#include <algorithm>
#include <optional>

#include "daemon/config/config_file.h"
#include "daemon/config/load_config.h"
#include "drivers/text/nearest_word.h"

namespace leonav {

std::string preset_names() {
  std::string names;
  for (const Preset& one : presets()) names += (names.empty() ? "" : ", ") + std::string(one.name);
  return names;
}

const Preset& find_preset(const std::string& name, const std::string& where) {
  const auto found = std::find_if(presets().begin(), presets().end(),
                                  [&](const Preset& one) { return one.name == name; });
  if (found != presets().end()) return *found;
  std::vector<std::string> names;
  for (const Preset& one : presets()) names.emplace_back(one.name);
  const auto near = nearest_word(name, names);
  throw ConfigError(where + ": unknown preset '" + name + "'; " +
                    (near ? "did you mean '" + *near + "'? " : "") + "presets: " + preset_names());
}

std::vector<ConfigLayer> preset_layers(const std::vector<ConfigLayer>& layers) {
  std::vector<ConfigNode> roots;
  for (const ConfigLayer& layer : layers) roots.push_back({&layer, layer.root});
  ConfigSource source;
  ConfigReader reader(&source, roots, "");
  std::optional<std::string> name;
  reader.text("preset", &name, "");
  if (!name) return {};
  const Preset& preset = find_preset(*name, reader.where("preset"));
  const ConfigLayer own = text_layer(std::string(preset.text), "preset " + *name);
  std::vector<ConfigLayer> found = preset_layers({own});
  found.push_back(own);
  return found;
}

}  // namespace leonav
