// Integrates a link's IMU block anew where the estimate has left the place it was linearized at.
#pragma once
#include <cstdint>
#include <memory>

#include "core/ekf/ekf.h"
#include "core/smoother/keyframe.h"

namespace leonav {

struct RelinkConfig {
  EkfConfig ekf;
  ImuErrorModel imu;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
  MotionConstraintConfig motion;
};

// Allocates when constructed, not after.
class Relinker {
 public:
  explicit Relinker(const RelinkConfig& config);

  // Nothing while the keyframe before is near where the link begins. Otherwise the link is moved to
  // begin there: position, velocity and attitude are integrated anew, F of the inertial states with
  // them, and constraints on the motion are met anew on the way, those that the filter has used.
  // What is linear anyway (clocks, ambiguities) follows its old F; the noise stays.
  void operator()(const Keyframe& before, Keyframe* keyframe);
  std::uint64_t relinked() const { return relinked_; }

 private:
  void propagate(const Keyframe& before, const Keyframe& keyframe);

  MotionConstraintConfig motion_;
  MotionMeasurements measurements_;
  std::unique_ptr<Ekf> propagator_;
  std::uint64_t relinked_ = 0;
};

}  // namespace leonav
