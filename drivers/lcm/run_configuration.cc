#include "drivers/lcm/run_configuration.h"

#include <leonav/config_t.hpp>
#include <leonav/end_t.hpp>
#include <sstream>

#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

constexpr std::size_t kStrings = 4;

// Checks the lengths of all strings, because the generated decoder does not.
bool strings_fit(ByteSpan bytes) {
  std::size_t at = wire::kSchemaOffset + 4;
  for (std::size_t i = 0; i < kStrings; ++i) {
    if (bytes.size() < at + 4) return false;
    const std::size_t length = wire::read_uint32(bytes, at);
    at += 4;
    // The length includes the final zero.
    if (length == 0 || length > bytes.size() - at) return false;
    at += length;
  }
  return at == bytes.size();
}

}  // namespace

std::vector<std::uint8_t> encode(const RunConfiguration& configuration) {
  config_t message{};
  message.sequence = 1;
  message.schema = wire::kSchema;
  message.program = configuration.program;
  message.name = configuration.name;
  message.text = configuration.text;
  for (const std::string& one : configuration.overrides) message.overrides += one + "\n";
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

std::optional<RunConfiguration> decode_run_configuration(ByteSpan bytes) {
  if (!strings_fit(bytes)) return std::nullopt;
  const int size = static_cast<int>(bytes.size());
  config_t message{};
  if (message.decode(bytes.data(), 0, size) != size) return std::nullopt;
  if (message.schema != wire::kSchema) return std::nullopt;
  RunConfiguration configuration{message.program, message.name, message.text, {}};
  std::istringstream lines(message.overrides);
  for (std::string line; std::getline(lines, line);) configuration.overrides.push_back(line);
  return configuration;
}

std::array<std::uint8_t, kJournalEndBytes> encode_journal_end(std::int64_t messages) {
  end_t message{};
  message.sequence = 1;
  message.schema = wire::kSchema;
  message.messages = messages;
  std::array<std::uint8_t, kJournalEndBytes> bytes{};
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

std::optional<std::int64_t> decode_journal_end(ByteSpan bytes) {
  const int size = static_cast<int>(bytes.size());
  end_t message{};
  if (message.decode(bytes.data(), 0, size) != size) return std::nullopt;
  if (message.schema != wire::kSchema) return std::nullopt;
  return message.messages;
}

}  // namespace leonav
