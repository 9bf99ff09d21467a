// MotionAidingConfig configures the constraints on the motion and the standstill detector.
#pragma once
#include "core/filter/update/motion_constraint.h"
#include "core/vehicle/standstill_detector.h"

namespace leonav {

struct MotionAidingConfig {
  MotionConstraintConfig constraints;
  StandstillConfig standstill;
  bool enabled() const { return constraints.non_holonomic || constraints.zero_velocity; }

  bool operator==(const MotionAidingConfig&) const = default;
};

}  // namespace leonav
