// Reads one group of a YAML configuration into typed fields. Each key is named once, where it is
// read: that one line gives its type, unit, bounds and, by what the field held before, its default.
#pragma once
#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace leonav {

// Bounds in the unit of the file, both allowed.
struct Bounds {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

// What all groups of one file share.
struct ConfigSource {
  std::string name;                 // for errors
  std::vector<std::string> absent;  // known keys that were left at their defaults
  // Overrides that say in full what was read from files: with them the configuration reads none.
  std::vector<std::string> resolved;
  std::vector<std::string> given = {};  // keys and groups that are there
};

class ConfigReader {
 public:
  // `node` must be a map or absent; `path` is "" at the root, else e.g. "gnss.gps".
  ConfigReader(ConfigSource* source, YAML::Node node, std::string path);

  // `*value` is set to the file's number times `unit`, or left alone if the key is absent.
  void number(const char* key, Bounds bounds, double* value, double unit = 1.0);
  void number(const char* key, Bounds bounds, std::optional<double>* value, double unit = 1.0);
  void vector(const char* key, Bounds bounds, Eigen::Vector3d* value, double unit = 1.0);
  // A list of numbers, of any length; left alone if the key is absent.
  void numbers(const char* key, Bounds bounds, std::vector<double>* values);
  void integer(const char* key, int min, int max, int* value);
  void boolean(const char* key, bool* value);
  void text(const char* key, std::string* value);
  // Whether the key is there with a single value; it is not counted as asked for.
  bool is_scalar(const char* key) const;
  // A list of scalars; false if absent.
  bool list(const char* key, std::vector<std::string>* values);
  void group(const char* key, const std::function<void(ConfigReader&)>& read);
  // A list of groups; false if absent.
  bool groups(const char* key, const std::function<void(ConfigReader&)>& read);

  template <typename Enum>
  void choice(const char* key, const std::vector<std::pair<std::string, Enum>>& choices,
              Enum* value) {
    std::vector<std::string> names;
    for (const auto& [name, meaning] : choices) names.push_back(name);
    if (const auto index = choice_index(key, names)) *value = choices[*index].second;
  }
  // Which of `names` the key's value is; throws, listing them, if it is none.
  std::optional<std::size_t> choice_index(const char* key, const std::vector<std::string>& names);

  // `key` stands for what a file said: `value` is its value in YAML.
  void resolve(const char* key, const std::string& value) {
    source_->resolved.push_back(path_of(key) + "=" + value);
  }

  // Where `key` stands, for errors that show later: "FILE:LINE: group.key", or "--set group.key".
  std::string where(const char* key) const;

  // Throws ConfigError for `key`, at its line.
  [[noreturn]] void fail(const char* key, const std::string& message) const;

  // Throws if the group has a key that was not asked for, or one twice.
  void finish() const;

 private:
  YAML::Node find(const char* key);
  std::string scalar(const char* key, const YAML::Node& node, const char* expected) const;
  double parse_number(const char* key, const YAML::Node& node, Bounds bounds) const;
  [[noreturn]] void fail_at(const YAML::Node& node, const std::string& key,
                            const std::string& message) const;
  std::string where_is(const YAML::Node& node, const std::string& key) const;
  std::string path_of(const std::string& key) const;

  ConfigSource* source_;
  YAML::Node node_;
  std::string path_;
  std::vector<std::string> known_;
};

}  // namespace leonav
