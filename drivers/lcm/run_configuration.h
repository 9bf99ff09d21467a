// These functions encode the first and the last message of a journal: configuration and clean stop.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/lcm/decode.h"

namespace leonav {

// The configuration of the run that wrote a journal.
struct RunConfiguration {
  std::string program;                 // name and version of the program that wrote the journal
  std::string name;                    // the configuration file, or "preset NAME"
  std::string text;                    // every key with its value, YAML
  std::vector<std::string> overrides;  // group.key=value, without line feeds; of older versions
};

std::vector<std::uint8_t> encode(const RunConfiguration& configuration);

// Returns the configuration; nullopt: the message is damaged or has another schema.
std::optional<RunConfiguration> decode_run_configuration(ByteSpan bytes);

inline constexpr std::size_t kJournalEndBytes = 8 + 8 + 8 + 4 + 8;

// Encodes the last message; `messages` is the number of messages before it.
// Allocates nothing.
std::array<std::uint8_t, kJournalEndBytes> encode_journal_end(std::int64_t messages);

// Returns the number of messages; nullopt: the message is damaged or has another schema.
std::optional<std::int64_t> decode_journal_end(ByteSpan bytes);

}  // namespace leonav
