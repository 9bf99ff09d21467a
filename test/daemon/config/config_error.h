// What a wrong configuration is told.
#pragma once
#include <string>
#include <vector>

#include "daemon/config/load_config.h"

namespace leonav::test {

// The message with which `text` of a file car.yaml is refused.
inline std::string error_of(const std::string& text,
                            const std::vector<std::string>& overrides = {}) {
  try {
    load_config_text(text, "car.yaml", overrides);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "(no error)";
}

}  // namespace leonav::test
