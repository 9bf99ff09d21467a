// Integrates a process_factor's IMU block anew where the estimate has left the place it was
// linearized at.
#pragma once
#include <cstdint>
#include <memory>

#include "core/filter/ekf.h"
#include "core/smoother/keyframe.h"

namespace leonav {

struct RepropagationConfig {
  EkfConfig ekf;
  ImuErrorModel imu;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
  MotionConstraintConfig motion;
};

// Allocates when constructed, not after.
class Repropagator {
 public:
  explicit Repropagator(const RepropagationConfig& config);

  // Nothing while the keyframe before is near where the process_factor begins. Otherwise the
  // process_factor is moved to begin there: position, velocity and attitude are integrated anew, F
  // of the inertial states with them, and constraints on the motion are met anew on the way, those
  // that the filter has used. What is linear anyway (clocks, ambiguities) follows its old F; the
  // noise stays.
  void operator()(const Keyframe& before, Keyframe* keyframe);
  std::uint64_t repropagations() const { return repropagations_; }

 private:
  void propagate(const Keyframe& before, const Keyframe& keyframe);

  MotionConstraintConfig motion_;
  MotionMeasurements measurements_;
  std::unique_ptr<Ekf> propagator_;
  std::uint64_t repropagations_ = 0;
};

}  // namespace leonav
