#include "drivers/lcm/output_schema.h"

#include "drivers/lcm/wire.h"

namespace leonav {

std::optional<OutputSchema> output_schema_of(Channel channel, std::span<const std::uint8_t> bytes) {
  const bool has_versions = channel == Channel::kSolution || channel == Channel::kEpoch ||
                            channel == Channel::kSmoother || channel == Channel::kSmoothed;
  if (!has_versions || bytes.size() < wire::kSchemaOffset + 4) return std::nullopt;
  const std::uint32_t schema = wire::read_uint32(bytes, wire::kSchemaOffset);
  for (const OutputSchema known : {OutputSchema::kFirst, OutputSchema::kNewest})
    if (schema == static_cast<std::uint32_t>(known)) return known;
  return std::nullopt;
}

}  // namespace leonav
