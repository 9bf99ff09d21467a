#include "core/filter/error_model/reflection.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace leonav {
namespace {

// One and four degrees give the same accuracy in simulated streets.
constexpr double kReflectionAngle = 2.0 * std::numbers::pi / 180.0;

}  // namespace

double longest_reflection_s(double line_of_sight_rate) {
  return line_of_sight_rate > 0.0 ? kReflectionAngle / line_of_sight_rate
                                  : std::numeric_limits<double>::infinity();
}

double reflected_random_walk(double detour_m, double line_of_sight_rate, double duration_s) {
  return detour_m * line_of_sight_rate * std::sqrt(duration_s);
}

}  // namespace leonav
