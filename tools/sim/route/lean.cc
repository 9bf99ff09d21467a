#include "tools/sim/route/lean.h"

#include <cmath>

namespace leonav::sim {
namespace {

constexpr double kGravity = 9.81;  // m/s^2
// Values of a passenger car's springs: about 5 degrees of roll and 2.5 of pitch at 1 g.
constexpr double kRollPerAcceleration = 0.009, kPitchPerAcceleration = 0.0045;  // rad/(m/s^2)
// A small multicopter leans about 6 degrees against the drag of 10 m/s.
constexpr double kDragPerSpeed = 0.1;  // 1/s

}  // namespace

Lean lean_of(VehicleKind kind, const PathMotion& motion) {
  if (kind == VehicleKind::kCar) {
    return {-kRollPerAcceleration * motion.lateral_m_s2,
            motion.slope + kPitchPerAcceleration * motion.along_m_s2};
  }
  const double push = motion.along_m_s2 + kDragPerSpeed * motion.speed_m_s;
  return {std::atan2(motion.lateral_m_s2, kGravity), -std::atan2(push, kGravity)};
}

}  // namespace leonav::sim
