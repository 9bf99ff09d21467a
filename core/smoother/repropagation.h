// Repropagator integrates the IMU block of a process factor again where the estimate has moved away
// from where the factor was linearized.
#pragma once
#include <cstdint>

#include "core/smoother/keyframe.h"
#include "core/smoother/process_propagation.h"

namespace leonav {

// Allocates when constructed, not after.
class Repropagator {
 public:
  explicit Repropagator(const ProcessPropagationConfig& config) : propagation_(config) {}

  // Does nothing while the keyframe before is near where the process factor begins. Otherwise the
  // factor is moved to begin there: position, velocity and attitude are integrated anew, with the F
  // of the inertial states, and the motion constraints that the filter has used are applied on the
  // way. What is linear anyway (clocks, ambiguities) follows its old F; the noise stays.
  void operator()(const Keyframe& before, Keyframe* keyframe);
  std::uint64_t repropagations() const { return repropagations_; }

 private:
  ProcessPropagation propagation_;
  std::uint64_t repropagations_ = 0;
};

}  // namespace leonav
