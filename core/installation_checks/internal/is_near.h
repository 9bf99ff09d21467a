// This function compares a value with an expected one by a share.
#pragma once
#include <cmath>

namespace leonav {

inline bool is_near(double value, double expected, double share) {
  return std::abs(value - expected) < share * std::abs(expected);
}

}  // namespace leonav
