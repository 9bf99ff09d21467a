#include "daemon/config/config_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "daemon/config/internal/yaml_text.h"
#include "daemon/config/load_config.h"
#include "drivers/text/nearest_word.h"

namespace leonav {
namespace {

std::string format(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string required(Bounds bounds) {
  if (std::isinf(bounds.max)) return "at least " + format(bounds.min);
  if (std::isinf(bounds.min)) return "at most " + format(bounds.max);
  return "between " + format(bounds.min) + " and " + format(bounds.max);
}

std::string range_text(Bounds bounds) {
  if (std::isinf(bounds.min) && std::isinf(bounds.max)) return "any number";
  if (std::isinf(bounds.max)) return "at least " + number_text(bounds.min);
  if (std::isinf(bounds.min)) return "at most " + number_text(bounds.max);
  return number_text(bounds.min) + " to " + number_text(bounds.max);
}

std::string numbers_text(const double* numbers, std::size_t count, double unit = 1.0) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += (i == 0 ? "" : ", ") + number_text(numbers[i], unit);
  }
  return "[" + text + "]";
}

std::string vector_text(const Eigen::Vector3d& vector, double unit = 1.0) {
  return numbers_text(vector.data(), 3, unit);
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// The value of a map's key.
std::optional<YAML::Node> entry_of(const YAML::Node& map, std::string_view key) {
  if (map.IsMap()) {
    for (const auto& entry : map) {
      if (entry.first.IsScalar() && entry.first.Scalar() == key) return entry.second;
    }
  }
  return std::nullopt;
}

// "FILE:LINE", or "--set".
std::string place_of(const ConfigNode& at) {
  if (at.layer->command_line) return "--set";
  return at.layer->name + ":" + std::to_string(at.node.Mark().line + 1);
}

}  // namespace

ConfigReader::ConfigReader(ConfigSource* source, std::vector<ConfigNode> nodes, std::string path)
    : source_(source), nodes_(std::move(nodes)), path_(std::move(path)) {
  for (const ConfigNode& one : nodes_) {
    if (!one.node.IsMap() && !one.node.IsNull()) {
      fail_at(one, "", "expected a group of keys (\"key: value\" lines)");
    }
  }
}

ConfigReader::Found ConfigReader::look_up(const char* key) const {
  for (auto one = nodes_.rbegin(); one != nodes_.rend(); ++one) {
    if (const auto node = entry_of(one->node, key)) return ConfigNode{one->layer, *node};
  }
  return std::nullopt;
}

ConfigReader::Found ConfigReader::find(const char* key) {
  known_.emplace_back(key);
  Found found = look_up(key);
  if (found) source_->given.push_back(path_of(key));
  return found;
}

ConfigKey& ConfigReader::record(const char* key, const Found& found, std::string allowed,
                                std::string built_in) {
  ConfigKey& one = source_->keys.emplace_back();
  one.path = path_of(key);
  one.allowed = std::move(allowed);
  one.built_in = std::move(built_in);
  one.value = one.built_in;
  one.given = found.has_value();
  if (found) one.origin = place_of(*found);
  return one;
}

void ConfigReader::fall_back(ConfigKey* key, const char* from, std::string value) {
  key->given = false;
  key->value = std::move(value);
  key->origin = std::string("default of ") + from;
}

std::string ConfigReader::scalar(const char* key, const ConfigNode& found,
                                 const char* expected) const {
  if (!found.node.IsScalar()) fail_at(found, key, std::string("expected ") + expected);
  return found.node.Scalar();
}

double ConfigReader::parse_number(const char* key, const ConfigNode& found, Bounds bounds) const {
  const std::string text = scalar(key, found, "a number");
  // Not yaml-cpp's conversion: it takes ".nan", "0x10" and octal 010.
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  double value = 0.0;
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    fail_at(found, key, "'" + text + "' is not a number");
  }
  if (value < bounds.min || value > bounds.max) {
    fail_at(found, key, text + " is out of range; must be " + required(bounds));
  }
  return value;
}

void ConfigReader::number(const char* key, Bounds bounds, double* value, double unit) {
  const Found found = find(key);
  ConfigKey& one = record(key, found, range_text(bounds), number_text(*value, unit));
  if (!found) return;
  attempt([&] {
    const double number = parse_number(key, *found, bounds);
    *value = number * unit;
    one.value = number_text(number);
  });
}

void ConfigReader::number(const char* key, Bounds bounds, std::optional<double>* value,
                          double unit) {
  const Found found = find(key);
  ConfigKey& one = record(key, found, "~ or " + range_text(bounds),
                          value->has_value() ? number_text(**value, unit) : "~");
  if (!found) return;
  if (found->node.IsNull()) {
    value->reset();
    one.value = "~";
    return;
  }
  attempt([&] {
    const double number = parse_number(key, *found, bounds);
    *value = number * unit;
    one.value = number_text(number);
  });
}

void ConfigReader::number_or(const char* key, Bounds bounds, double fallback, const char* from,
                             double* value, double unit) {
  std::optional<double> given;
  number(key, bounds, &given, unit);
  *value = given.value_or(fallback);
  if (!given) fall_back(&source_->keys.back(), from, number_text(fallback, unit));
}

Eigen::Vector3d ConfigReader::parse_vector(const char* key, const ConfigNode& found,
                                           Bounds bounds) const {
  if (!found.node.IsSequence() || found.node.size() != 3) {
    fail_at(found, key, "expected [x, y, z]");
  }
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) {
    const ConfigNode element{found.layer, found.node[static_cast<std::size_t>(i)]};
    vector[i] = parse_number(key, element, bounds);
  }
  return vector;
}

void ConfigReader::vector(const char* key, Bounds bounds, Eigen::Vector3d* value, double unit) {
  const Found found = find(key);
  ConfigKey& one = record(key, found, "each " + range_text(bounds), vector_text(*value, unit));
  if (!found) return;
  attempt([&] {
    const Eigen::Vector3d vector = parse_vector(key, *found, bounds);
    one.value = vector_text(vector);
    for (int i = 0; i < 3; ++i) (*value)[i] = vector[i] * unit;
  });
}

void ConfigReader::vector_or(const char* key, Bounds bounds, const Eigen::Vector3d& fallback,
                             const char* from, Eigen::Vector3d* value) {
  const Found found = find(key);
  ConfigKey& one = record(key, found, "~ or each " + range_text(bounds), "~");
  if (!found || found->node.IsNull()) {
    *value = fallback;
    fall_back(&one, from, vector_text(fallback));
    return;
  }
  attempt([&] {
    *value = parse_vector(key, *found, bounds);
    one.value = vector_text(*value);
  });
}

void ConfigReader::numbers(const char* key, Bounds bounds, std::vector<double>* values) {
  const Found found = find(key);
  ConfigKey& one = record(key, found, "list of numbers, each " + range_text(bounds),
                          numbers_text(values->data(), values->size()));
  if (!found) return;
  attempt([&] {
    if (!found->node.IsSequence()) fail_at(*found, key, "expected a list of numbers, as in [1, 2]");
    values->clear();
    for (const YAML::Node& element : found->node) {
      values->push_back(parse_number(key, {found->layer, element}, bounds));
    }
    one.value = numbers_text(values->data(), values->size());
  });
}

void ConfigReader::integer(const char* key, int min, int max, int* value) {
  double number_value = *value;
  number(key, {static_cast<double>(min), static_cast<double>(max)}, &number_value);
  source_->keys.back().allowed.insert(0, "whole number, ");
  attempt([&] {
    if (number_value != std::floor(number_value)) fail(key, "must be a whole number");
    *value = static_cast<int>(number_value);
  });
}

void ConfigReader::boolean(const char* key, bool* value) {
  choice<bool>(key, {{"true", true}, {"false", false}}, value);
}

void ConfigReader::switch_or(const char* key, bool fallback, const char* from, bool* value) {
  enum class Switch : unsigned char { kByKind, kOn, kOff };
  Switch choice_made = Switch::kByKind;
  choice<Switch>(key,
                 {{"by_kind", Switch::kByKind}, {"true", Switch::kOn}, {"false", Switch::kOff}},
                 &choice_made);
  *value = choice_made == Switch::kByKind ? fallback : choice_made == Switch::kOn;
  if (choice_made == Switch::kByKind)
    fall_back(&source_->keys.back(), from, fallback ? "true" : "false");
}

void ConfigReader::text(const char* key, std::string* value, const std::string& allowed) {
  const Found found = find(key);
  ConfigKey& one = record(key, found, allowed, plain_text(*value));
  if (!found) return;
  attempt([&] {
    *value = found->node.IsNull() ? std::string() : scalar(key, *found, "a text");
    one.value = plain_text(*value);
  });
}

void ConfigReader::text(const char* key, std::optional<std::string>* value,
                        const std::string& allowed) {
  const Found found = find(key);
  ConfigKey& one = record(key, found, allowed, value->has_value() ? plain_text(**value) : "~");
  if (!found) return;
  value->reset();
  attempt([&] {
    if (!found->node.IsNull()) *value = scalar(key, *found, "a text");
  });
  one.value = value->has_value() ? plain_text(**value) : "~";
}

bool ConfigReader::is_scalar(const char* key) const {
  const Found found = look_up(key);
  return found && found->node.IsScalar();
}

bool ConfigReader::list(const char* key, std::vector<std::string>* values,
                        const std::string& allowed) {
  const Found found = find(key);
  ConfigKey& one = record(key, found, allowed, list_text(*values));
  if (!found) return false;
  attempt([&] {
    if (!found->node.IsSequence()) fail_at(*found, key, "expected a list, as in [a, b]");
    values->clear();
    for (const YAML::Node& element : found->node) {
      values->push_back(scalar(key, {found->layer, element}, "a list of plain values"));
    }
    one.value = list_text(*values);
  });
  return true;
}

void ConfigReader::group(const char* key, const std::function<void(ConfigReader&)>& read) {
  find(key);
  attempt([&] {
    std::vector<ConfigNode> parts;
    for (const ConfigNode& one : nodes_) {
      const auto node = entry_of(one.node, key);
      if (!node) continue;
      const ConfigNode part{one.layer, *node};
      if (part.layer->command_line && part.node.IsNull()) {
        fail_at(part, key, "set one key at a time");
      }
      parts.push_back(part);
    }
    ConfigReader reader(source_, std::move(parts), path_of(key));
    read(reader);
    reader.finish();
  });
}

bool ConfigReader::groups(const char* key, const std::function<void(ConfigReader&)>& read) {
  const Found found = find(key);
  if (!found) return false;
  attempt([&] {
    if (!found->node.IsSequence()) {
      fail_at(*found, key, "expected a list of groups (\"- key: value\" lines)");
    }
  });
  if (!found->node.IsSequence()) return true;
  for (std::size_t i = 0; i < found->node.size(); ++i) {
    attempt([&] {
      ConfigReader reader(source_, {{found->layer, found->node[i]}},
                          path_of(key) + "[" + std::to_string(i) + "]");
      read(reader);
      reader.finish();
    });
  }
  return true;
}

std::optional<std::size_t> ConfigReader::choice_index(const char* key,
                                                      const std::vector<std::string>& names,
                                                      const std::string& built_in) {
  const Found found = find(key);
  ConfigKey& one = record(key, found, alternatives(names), built_in);
  if (!found) return std::nullopt;
  std::optional<std::size_t> index;
  attempt([&] {
    one.value = scalar(key, *found, ("one of " + join(names)).c_str());
    const auto name = std::find(names.begin(), names.end(), one.value);
    if (name == names.end()) {
      fail_at(*found, key, "'" + one.value + "' is not one of " + join(names));
    }
    index = static_cast<std::size_t>(name - names.begin());
  });
  return index;
}

void ConfigReader::resolve(const char* key, const std::string& value, const char* origin) {
  const std::string path = path_of(key), origin_path = path_of(origin);
  const auto find_key = [&](const std::string& wanted) {
    return std::find_if(source_->keys.begin(), source_->keys.end(),
                        [&](const ConfigKey& one) { return one.path == wanted; });
  };
  const auto one = find_key(path), named = find_key(origin_path);
  if (one == source_->keys.end() || named == source_->keys.end()) return;
  one->value = value;
  one->given = true;
  one->origin = named->origin;
}

std::string ConfigReader::where(const char* key) const {
  if (const Found found = look_up(key)) return where_is(*found, key);
  if (!nodes_.empty()) return where_is(nodes_.back(), key);
  return source_->name + ": " + path_of(key);
}

void ConfigReader::report(const char* key, const std::string& message) const {
  source_->errors.push_back(where(key) + ": " + message);
}

void ConfigReader::fail(const char* key, const std::string& message) const {
  throw ConfigError(where(key) + ": " + message);
}

void ConfigReader::finish() {
  for (const ConfigNode& one : nodes_) {
    std::vector<std::string> seen;
    for (const auto& entry : one.node) {
      const ConfigNode at{one.layer, entry.first};
      attempt([&] { check_key(at, &seen); });
    }
  }
}

void ConfigReader::check_key(const ConfigNode& at, std::vector<std::string>* seen) const {
  if (!at.node.IsScalar()) fail_at(at, "", "a key must be a plain word");
  const std::string key = at.node.Scalar();
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
    const auto near = nearest_word(key, known_);
    fail_at(at, key,
            near ? "unknown key; did you mean '" + *near + "'?"
                 : "unknown key; known here: " + join(known_));
  }
  if (std::find(seen->begin(), seen->end(), key) != seen->end())
    fail_at(at, key, "given twice; remove one");
  seen->push_back(key);
}

void ConfigReader::attempt(const std::function<void()>& read) {
  try {
    read();
  } catch (const ConfigError& error) {
    source_->errors.emplace_back(error.what());
  }
}

std::string ConfigReader::path_of(const std::string& key) const {
  if (path_.empty() || key.empty()) return path_ + key;
  return path_ + "." + key;
}

void ConfigReader::fail_at(const ConfigNode& at, const std::string& key,
                           const std::string& message) const {
  throw ConfigError(where_is(at, key) + ": " + message);
}

std::string ConfigReader::where_is(const ConfigNode& at, const std::string& key) const {
  return place_of(at) + (at.layer->command_line ? " " : ": ") + path_of(key);
}

}  // namespace leonav
