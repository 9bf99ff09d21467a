// What a journal's run was made with, as the journal's first message.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/lcm/decode.h"

namespace leonav {

struct RunConfiguration {
  std::string program;                 // name and version of what wrote the journal
  std::string name;                    // the configuration file
  std::string text;                    // its content
  std::vector<std::string> overrides;  // group.key=value, without line feeds
};

std::vector<std::uint8_t> encode(const RunConfiguration& configuration);

// nullopt: damaged, or of another schema.
std::optional<RunConfiguration> decode_run_configuration(ByteSpan bytes);

}  // namespace leonav
