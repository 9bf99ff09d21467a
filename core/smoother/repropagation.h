// Repropagator integrates the IMU block of a process factor from the window's own estimate: of a
// new keyframe, and again where the estimate has moved away from where the factor was linearized.
#pragma once
#include <cstdint>

#include "core/smoother/keyframe.h"
#include "core/smoother/process_propagation.h"

namespace leonav {

// Allocates when constructed, not after.
class Repropagator {
 public:
  explicit Repropagator(const ProcessPropagationConfig& config) : propagation_(config) {}

  // Makes the inertial part of a new keyframe's process factor the window's own: position,
  // velocity, attitude, IMU errors and vehicle constants with their F and N are integrated from the
  // estimate of the keyframe before, with the motion constraints that the filter has used. What is
  // linear anyway (clocks, delays, ambiguities) follows the F and N it has. Does nothing without an
  // attitude, or if samples are missing.
  void integrate(const Keyframe& before, Keyframe* keyframe);
  // Integrates again where the keyframe before has moved away from where the factor begins, and
  // returns whether it did.
  bool operator()(const Keyframe& before, Keyframe* keyframe);
  // Returns the motion of the body at the end of the last factor that was integrated.
  const BodyMotion& body() const { return propagation_.body(); }
  std::uint64_t repropagations() const { return repropagations_; }

 private:
  ProcessPropagation propagation_;
  std::uint64_t repropagations_ = 0;
};

}  // namespace leonav
