// These constants convert angles: inside leonav they are in radians, at its edges often in degrees.
#pragma once
#include <cmath>
#include <numbers>

namespace leonav {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180.0;            // rad
inline constexpr double kDegreesPerRadian = 180.0 / kPi;  // deg

// Returns an angle given in degrees, of any number of turns, as one of less than a turn in radians.
inline double reduced_angle(double degrees) { return std::fmod(degrees, 360.0) * kDegree; }

}  // namespace leonav
