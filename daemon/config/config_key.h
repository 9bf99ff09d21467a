// ConfigKey is one key of a configuration as it was read: allowed values, value, and origin.
#pragma once
#include <string>

namespace leonav {

struct ConfigKey {
  std::string path;      // "gnss.gps.code_sigma_m"
  std::string allowed;   // its values in words, e.g. "0.001 to 1000"
  std::string built_in;  // its default, in YAML; "~" and "by_kind" where other keys decide
  std::string value;     // the effective value, in YAML
  // "default", "default of vehicle.kind", "preset car:4", "vehicle.yaml:12" or "--set".
  std::string origin = "default";
  bool given = false;  // by a file, a preset or the command line; false: the default holds

  bool is_default() const { return !given || value == built_in; }
};

}  // namespace leonav
