// The outputs that a replay must reproduce are grouped here, so that each group has one order.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"

namespace leonav {

// The order within a group does not depend on how threads interleave. SOLUTION, DECISION (of the
// inertial stage), EPOCH, EVENT by stage, SMOOTHER, DECISION of the GNSS stage, and SMOOTHED.
inline constexpr std::array<std::string_view, 10> kOutputGroups = {
    "SOLUTION",   "DECISION",       "EPOCH",    "EVENT sequencer",   "EVENT inertial",
    "EVENT gnss", "EVENT smoother", "SMOOTHER", "DECISION keyframe", "SMOOTHED"};

inline constexpr std::size_t kSolutionGroup = 0, kEpochGroup = 2, kSmoothedGroup = 9;

// nullopt: not compared (inputs; HEALTH, which depends on the machine).
std::optional<std::size_t> output_group(Channel channel, ByteSpan bytes);

}  // namespace leonav
