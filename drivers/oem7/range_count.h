// The logs of ranges begin with a count: of measurements, or of the bytes that follow.
#pragma once
#include <cstddef>

namespace leonav {

inline constexpr std::size_t kCountSize = 4;

}  // namespace leonav
