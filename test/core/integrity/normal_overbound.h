// An overbound that is the stated normal distribution itself.
#pragma once
#include "core/integrity/integrity_config.h"

namespace leonav::test {

inline constexpr Overbound kNormal = {1.0, 0.0, 1.0};

}  // namespace leonav::test
