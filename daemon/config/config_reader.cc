#include "daemon/config/config_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "daemon/config/load_config.h"
#include "drivers/text/nearest_word.h"

namespace leonav {
namespace {

std::string format(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string allowed(Bounds bounds) {
  if (std::isinf(bounds.max)) return "at least " + format(bounds.min);
  if (std::isinf(bounds.min)) return "at most " + format(bounds.max);
  return "between " + format(bounds.min) + " and " + format(bounds.max);
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

ConfigReader::ConfigReader(ConfigSource* source, YAML::Node node, std::string path)
    : source_(source), node_(std::move(node)), path_(std::move(path)) {
  if (node_.IsDefined() && !node_.IsNull() && !node_.IsMap()) {
    fail_at(node_, "", "expected a group of keys (\"key: value\" lines)");
  }
}

YAML::Node ConfigReader::find(const char* key) {
  known_.emplace_back(key);
  if (node_.IsDefined() && node_.IsMap()) {
    for (const auto& entry : node_) {
      if (!entry.first.IsScalar() || entry.first.Scalar() != key) continue;
      source_->given.push_back(path_of(key));
      return entry.second;
    }
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

std::string ConfigReader::scalar(const char* key, const YAML::Node& node,
                                 const char* expected) const {
  if (!node.IsScalar()) fail_at(node, key, std::string("expected ") + expected);
  return node.Scalar();
}

double ConfigReader::parse_number(const char* key, const YAML::Node& node, Bounds bounds) const {
  const std::string text = scalar(key, node, "a number");
  // Not yaml-cpp's conversion: it takes ".nan", "0x10" and octal 010.
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  double value = 0.0;
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    fail_at(node, key, "'" + text + "' is not a number");
  }
  if (value < bounds.min || value > bounds.max) {
    fail_at(node, key, text + " is out of range; must be " + allowed(bounds));
  }
  return value;
}

void ConfigReader::number(const char* key, Bounds bounds, double* value, double unit) {
  if (const YAML::Node node = find(key); node.IsDefined()) {
    *value = parse_number(key, node, bounds) * unit;
  } else {
    source_->absent.push_back(path_of(key));
  }
}

void ConfigReader::number(const char* key, Bounds bounds, std::optional<double>* value,
                          double unit) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) {
    source_->absent.push_back(path_of(key));
  } else if (node.IsNull()) {
    value->reset();
  } else {
    *value = parse_number(key, node, bounds) * unit;
  }
}

void ConfigReader::vector(const char* key, Bounds bounds, Eigen::Vector3d* value, double unit) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) {
    source_->absent.push_back(path_of(key));
    return;
  }
  if (!node.IsSequence() || node.size() != 3) fail_at(node, key, "expected [x, y, z]");
  for (int i = 0; i < 3; ++i) {
    (*value)[i] = parse_number(key, node[static_cast<std::size_t>(i)], bounds) * unit;
  }
}

void ConfigReader::numbers(const char* key, Bounds bounds, std::vector<double>* values) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) {
    source_->absent.push_back(path_of(key));
    return;
  }
  if (!node.IsSequence()) fail_at(node, key, "expected a list of numbers, as in [1, 2]");
  values->clear();
  for (const YAML::Node& element : node) values->push_back(parse_number(key, element, bounds));
}

void ConfigReader::integer(const char* key, int min, int max, int* value) {
  double number_value = *value;
  number(key, {static_cast<double>(min), static_cast<double>(max)}, &number_value);
  if (number_value != std::floor(number_value)) fail(key, "must be a whole number");
  *value = static_cast<int>(number_value);
}

void ConfigReader::boolean(const char* key, bool* value) {
  choice<bool>(key, {{"true", true}, {"false", false}}, value);
}

void ConfigReader::text(const char* key, std::string* value) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) {
    source_->absent.push_back(path_of(key));
  } else {
    *value = node.IsNull() ? std::string() : scalar(key, node, "a text");
  }
}

bool ConfigReader::is_scalar(const char* key) const {
  if (!node_.IsDefined() || !node_.IsMap()) return false;
  for (const auto& entry : node_) {
    if (entry.first.IsScalar() && entry.first.Scalar() == key) return entry.second.IsScalar();
  }
  return false;
}

bool ConfigReader::list(const char* key, std::vector<std::string>* values) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) {
    source_->absent.push_back(path_of(key));
    return false;
  }
  if (!node.IsSequence()) fail_at(node, key, "expected a list, as in [a, b]");
  values->clear();
  for (const YAML::Node& element : node) {
    values->push_back(scalar(key, element, "a list of plain values"));
  }
  return true;
}

void ConfigReader::group(const char* key, const std::function<void(ConfigReader&)>& read) {
  ConfigReader reader(source_, find(key), path_of(key));
  read(reader);
  reader.finish();
}

bool ConfigReader::groups(const char* key, const std::function<void(ConfigReader&)>& read) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) {
    source_->absent.push_back(path_of(key));
    return false;
  }
  if (!node.IsSequence()) fail_at(node, key, "expected a list of groups (\"- key: value\" lines)");
  for (std::size_t i = 0; i < node.size(); ++i) {
    ConfigReader reader(source_, node[i], path_of(key) + "[" + std::to_string(i) + "]");
    read(reader);
    reader.finish();
  }
  return true;
}

std::optional<std::size_t> ConfigReader::choice_index(const char* key,
                                                      const std::vector<std::string>& names) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) {
    source_->absent.push_back(path_of(key));
    return std::nullopt;
  }
  const std::string text = scalar(key, node, ("one of " + join(names)).c_str());
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) {
    fail_at(node, key, "'" + text + "' is not one of " + join(names));
  }
  return static_cast<std::size_t>(found - names.begin());
}

std::string ConfigReader::where(const char* key) const {
  YAML::Node at = node_;
  if (node_.IsDefined() && node_.IsMap()) {
    for (const auto& entry : node_) {
      if (entry.first.IsScalar() && entry.first.Scalar() == key) at.reset(entry.second);
    }
  }
  return where_is(at, key);
}

void ConfigReader::fail(const char* key, const std::string& message) const {
  throw ConfigError(where(key) + ": " + message);
}

void ConfigReader::finish() const {
  if (!node_.IsDefined() || !node_.IsMap()) return;
  std::vector<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) fail_at(entry.first, "", "a key must be a plain word");
    const std::string key = entry.first.Scalar();
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
      const auto near = nearest_word(key, known_);
      fail_at(entry.first, key,
              near ? "unknown key; did you mean '" + *near + "'?"
                   : "unknown key; known here: " + join(known_));
    }
    if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
      fail_at(entry.first, key, "given twice; remove one");
    }
    seen.push_back(key);
  }
}

std::string ConfigReader::path_of(const std::string& key) const {
  if (path_.empty() || key.empty()) return path_ + key;
  return path_ + "." + key;
}

void ConfigReader::fail_at(const YAML::Node& node, const std::string& key,
                           const std::string& message) const {
  throw ConfigError(where_is(node, key) + ": " + message);
}

std::string ConfigReader::where_is(const YAML::Node& node, const std::string& key) const {
  const YAML::Mark mark = node.IsDefined() ? node.Mark() : YAML::Mark::null_mark();
  // Nodes that came from the command line have no place in the file.
  if (mark.is_null() || mark.line < 0) return "--set " + path_of(key);
  return source_->name + ":" + std::to_string(mark.line + 1) + ": " + path_of(key);
}

}  // namespace leonav
