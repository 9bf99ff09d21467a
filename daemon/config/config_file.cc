#include "daemon/config/config_file.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

#include "daemon/config/internal/key_path.h"
#include "daemon/config/load_config.h"
#include "drivers/yaml/one_document.h"

namespace leonav {
namespace {

constexpr std::size_t kMostBytes = 1'000'000;

// One a line, each once.
std::string all_of(const std::vector<std::string>& errors) {
  std::string text;
  std::set<std::string> seen;
  for (const std::string& error : errors) {
    if (seen.insert(error).second) text += (text.empty() ? "" : "\n") + error;
  }
  return text;
}

void apply_override(const std::string& text, YAML::Node root) {
  const auto equals = text.find('=');
  const std::string path = text.substr(0, equals);
  const std::vector<std::string> keys = split_key_path(path);
  bool good = equals != std::string::npos;
  for (const std::string& key : keys) good = good && !key.empty();
  if (!good) throw ConfigError("--set " + text + ": expected group.key=value");
  // A journal holds one override in a line.
  if (text.find('\n') != std::string::npos)
    throw ConfigError("--set " + path + ": more than a line");
  YAML::Node value;
  try {
    value = YAML::Load(text.substr(equals + 1));
  } catch (const YAML::Exception& error) {
    throw ConfigError("--set " + path + ": " + error.msg);
  }
  YAML::Node node = root;
  for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
    YAML::Node child = node[keys[i]];
    if (child.IsDefined() && !child.IsNull() && !child.IsMap()) {
      throw ConfigError("--set " + path + ": '" + keys[i] + "' is not a group");
    }
    node.reset(child);
  }
  if (!value.IsSequence() && !value.IsScalar() && !value.IsNull()) {
    throw ConfigError("--set " + path + ": set one key at a time");
  }
  node[keys.back()] = value;
}

}  // namespace

std::string read_config_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw ConfigError(path + ": is a directory, not a configuration file");
  }
  std::ifstream file(path);
  if (!file) {
    throw ConfigError(path + ": cannot be opened: " + std::strerror(errno) +
                      "; a configuration may be one line, \"preset: car\"");
  }
  // A piece more than any configuration has at most, so that a device without an end is refused.
  std::string text;
  std::array<char, 4096> piece;
  do {
    file.read(piece.data(), piece.size());
    text.append(piece.data(), static_cast<std::size_t>(file.gcount()));
  } while (file && text.size() <= kMostBytes);
  if (text.size() > kMostBytes)
    throw ConfigError(path + ": is longer than a megabyte, which no configuration is");
  return text;
}

ConfigLayer text_layer(const std::string& text, const std::string& name) {
  try {
    const YAML::Node root = load_one_document(text);
    if (root.IsNull()) throw ConfigError(name + ": is empty");
    if (!root.IsMap()) throw ConfigError(name + ":1: expected groups of keys");
    return {name, root};
  } catch (const YAML::Exception& error) {
    throw ConfigError(name + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}

ConfigLayer override_layer(const std::vector<std::string>& overrides) {
  const YAML::Node root(YAML::NodeType::Map);
  for (const std::string& one : overrides) apply_override(one, root);
  return {"--set", root, true};
}

void read_layers(const std::vector<ConfigLayer>& layers, ConfigSource* source,
                 const std::function<void(ConfigReader&)>& read) {
  std::vector<ConfigNode> roots;
  for (const ConfigLayer& layer : layers) roots.push_back({&layer, layer.root});
  try {
    ConfigReader reader(source, roots, "");
    read(reader);
    reader.finish();
  } catch (const YAML::Exception& error) {
    source->errors.push_back(source->name + ": " + error.msg);
  } catch (const ConfigError& error) {
    source->errors.emplace_back(error.what());
  }
  if (!source->errors.empty()) throw ConfigError(all_of(source->errors));
}

void read_yaml(const std::string& text, const std::vector<std::string>& overrides,
               ConfigSource* source, const std::function<void(ConfigReader&)>& read) {
  read_layers({text_layer(text, source->name), override_layer(overrides)}, source, read);
}

}  // namespace leonav
