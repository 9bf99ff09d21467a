// OutputSchema is the version of the messages SOLUTION, EPOCH and SMOOTHER.
//
// The version grows when one of these types changes. Journals of an older version are compared in
// their own: lcmtypes/ keeps its types (solution_v1_t and others), whose fingerprints are those of
// the types that were.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/lcm/channels.h"

namespace leonav {

enum class OutputSchema : std::int32_t {
  kFirst = 1,   // without protection levels
  kNewest = 2,  // with protection levels
};

// Returns the version of a message, as it claims it; nullopt: the channel has no versions, or the
// version is not known.
std::optional<OutputSchema> output_schema_of(Channel channel, std::span<const std::uint8_t> bytes);

}  // namespace leonav
