// The outputs that replay must reproduce, in groups whose inner order does not depend on how
// threads interleave.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"

namespace leonav {

// SOLUTION, DECISION, EPOCH, and EVENT by stage.
inline constexpr std::array<std::string_view, 7> kOutputGroups = {
    "SOLUTION",       "DECISION",   "EPOCH",         "EVENT sequencer",
    "EVENT inertial", "EVENT gnss", "EVENT smoother"};

// nullopt: not compared (inputs; HEALTH, which tells of the machine).
std::optional<std::size_t> output_group(Channel channel, ByteSpan bytes);

}  // namespace leonav
