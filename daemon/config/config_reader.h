// ConfigReader reads one group of a YAML configuration into typed fields.
//
// Each key is named once, where it is read: that line gives its type, unit and bounds, and the
// field's value before the call is its default. Every key that is read is recorded with all of
// these. A value that cannot be used is noted in ConfigSource::errors and leaves the default, so
// that all errors of a configuration are told at once.
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

#include "daemon/config/config_key.h"

namespace leonav {

// Bounds in the unit of the file, both allowed.
struct Bounds {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

// One source of values: a preset, a file, or the command line. A later layer takes precedence over
// an earlier one, key by key.
struct ConfigLayer {
  std::string name;           // for errors: of the file, or "preset NAME"
  YAML::Node root;            // a map, or null where nothing is given
  bool command_line = false;  // its values have no line
};

// A layer's value of one key, or its part of one group.
struct ConfigNode {
  const ConfigLayer* layer = nullptr;
  YAML::Node node;
};

// State that all groups of one configuration share.
struct ConfigSource {
  std::string name;                      // for errors where no layer has the key
  std::vector<std::string> given = {};   // keys and groups that are there
  std::vector<ConfigKey> keys = {};      // every key that was read, in that order
  std::vector<std::string> errors = {};  // what is wrong, in the order of reading
};

class ConfigReader {
 public:
  // `nodes`: the layers' parts of the group, later ones taking precedence; each must be a map or
  // null. `path` is "" at the root, else e.g. "gnss.gps".
  ConfigReader(ConfigSource* source, std::vector<ConfigNode> nodes, std::string path);

  // Sets `*value` to the file's number times `unit`; leaves it as it is if the key is absent.
  void number(const char* key, Bounds bounds, double* value, double unit = 1.0);
  void number(const char* key, Bounds bounds, std::optional<double>* value, double unit = 1.0);
  void vector(const char* key, Bounds bounds, Eigen::Vector3d* value, double unit = 1.0);
  // Reads a list of numbers of any length.
  void numbers(const char* key, Bounds bounds, std::vector<double>* values);
  void integer(const char* key, int min, int max, int* value);
  void boolean(const char* key, bool* value);
  // `allowed`: the allowed values in words.
  void text(const char* key, std::string* value, const std::string& allowed = "text");
  // "~" stands for none.
  void text(const char* key, std::optional<std::string>* value, const std::string& allowed);
  // True if the key is present with a single value. Does not count as reading the key.
  bool is_scalar(const char* key) const;
  // Reads a list of scalars; returns false if the key is absent.
  bool list(const char* key, std::vector<std::string>* values, const std::string& allowed = "list");
  void group(const char* key, const std::function<void(ConfigReader&)>& read);
  // Reads a list of groups; returns false if the key is absent.
  bool groups(const char* key, const std::function<void(ConfigReader&)>& read);

  // Keys whose default depends on another key, `from`: absent, or given as "~" (a switch:
  // "by_kind"), they have the value `fallback`.
  void number_or(const char* key, Bounds bounds, double fallback, const char* from, double* value,
                 double unit = 1.0);
  void vector_or(const char* key, Bounds bounds, const Eigen::Vector3d& fallback, const char* from,
                 Eigen::Vector3d* value);
  void switch_or(const char* key, bool fallback, const char* from, bool* value);

  template <typename Enum>
  void choice(const char* key, const std::vector<std::pair<std::string, Enum>>& choices,
              Enum* value) {
    std::vector<std::string> names;
    std::string built_in;
    for (const auto& [name, meaning] : choices) {
      names.push_back(name);
      if (meaning == *value) built_in = name;
    }
    if (const auto index = choice_index(key, names, built_in)) *value = choices[*index].second;
  }

  // `key` was replaced by what a file contains that the key `origin` names: `value`, in YAML.
  void resolve(const char* key, const std::string& value, const char* origin);

  // Where `key` stands, for errors that show later: "FILE:LINE: group.key", or "--set group.key".
  std::string where(const char* key) const;

  // Notes that `key`, at its line, cannot be as it is. Reading goes on, so that the rest of the
  // group is judged too.
  void report(const char* key, const std::string& message) const;
  // Notes the ConfigError that `read` throws, so that the keys behind it are read as well.
  void attempt(const std::function<void()>& read);
  // Throws ConfigError for `key`, at its line: for a key that decides which others there are. The
  // rest of its group is then not read, and none of its keys is called unknown.
  [[noreturn]] void fail(const char* key, const std::string& message) const;

  // Notes an error where the group has a key that was not asked for, or one twice.
  void finish();

 private:
  using Found = std::optional<ConfigNode>;
  void check_key(const ConfigNode& at, std::vector<std::string>* seen) const;
  // Returns the index in `names` of the key's value; throws, listing them, if it is none.
  std::optional<std::size_t> choice_index(const char* key, const std::vector<std::string>& names,
                                          const std::string& built_in);
  Found look_up(const char* key) const;
  Found find(const char* key);
  ConfigKey& record(const char* key, const Found& found, std::string allowed, std::string built_in);
  // Marks that the default that follows from the key `from` holds.
  static void fall_back(ConfigKey* key, const char* from, std::string value);
  Eigen::Vector3d parse_vector(const char* key, const ConfigNode& found, Bounds bounds) const;
  std::string scalar(const char* key, const ConfigNode& found, const char* expected) const;
  double parse_number(const char* key, const ConfigNode& found, Bounds bounds) const;
  [[noreturn]] void fail_at(const ConfigNode& at, const std::string& key,
                            const std::string& message) const;
  std::string where_is(const ConfigNode& at, const std::string& key) const;
  std::string path_of(const std::string& key) const;

  ConfigSource* source_;
  std::vector<ConfigNode> nodes_;
  std::string path_;
  std::vector<std::string> known_;
};

}  // namespace leonav
