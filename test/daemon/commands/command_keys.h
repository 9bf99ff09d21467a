// The keys of tests of signed commands, and the unit of their times.
#pragma once
#include <cstdint>

#include "core/base/gps_time.h"
#include "daemon/commands/command_key.h"

namespace leonav::test {

inline constexpr std::int64_t kSecond = kNanosecondsPerSecond;
inline const CommandKey kKey("0123456789abcdef0123456789abcdef");
inline const CommandKey kOtherKey("0123456789abcdef0123456789abcdeF");

}  // namespace leonav::test
