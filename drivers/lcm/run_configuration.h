// A journal begins with the configuration of its run and ends with a message of a clean stop.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/lcm/decode.h"

namespace leonav {

struct RunConfiguration {
  std::string program;                 // name and version of what wrote the journal
  std::string name;                    // the configuration file, or "preset NAME"
  std::string text;                    // every key with its value, YAML
  std::vector<std::string> overrides;  // group.key=value, without line feeds; of older versions
};

std::vector<std::uint8_t> encode(const RunConfiguration& configuration);

// nullopt: damaged, or of another schema.
std::optional<RunConfiguration> decode_run_configuration(ByteSpan bytes);

// `messages`: number of messages in the journal before this one.
std::vector<std::uint8_t> encode_journal_end(std::int64_t messages);

// The number of messages; nullopt: damaged, or of another schema.
std::optional<std::int64_t> decode_journal_end(ByteSpan bytes);

}  // namespace leonav
