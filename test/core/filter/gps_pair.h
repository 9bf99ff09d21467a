// The frequencies of a GPS pair, for tests that know its wavelengths.
#pragma once

namespace leonav::test {

inline constexpr double kL1 = 1575.42e6, kL2 = 1227.60e6;  // Hz

}  // namespace leonav::test
