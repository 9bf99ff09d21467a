// The class of a code, for the tests of what is learned.
#pragma once
#include "core/filter/error_model/error_class.h"

namespace leonav::test {

inline ErrorClass code_class(std::size_t elevation, std::size_t motion = 0) {
  ErrorClass of;
  of.observable = static_cast<std::size_t>(Observable::kCode);
  of.elevation = elevation;
  of.motion = motion;
  return of;
}

}  // namespace leonav::test
