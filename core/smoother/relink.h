// Integrates a link's IMU block anew where the estimate has left the place it was linearized at.
#pragma once
#include "core/ekf/ekf_config.h"
#include "core/ins/imu_error_model.h"
#include "core/smoother/keyframe.h"

namespace leonav {

struct RelinkConfig {
  EkfConfig ekf;
  ImuErrorModel imu;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
};

class Relinker {
 public:
  explicit Relinker(const RelinkConfig& config) : config_(config) {}

  // Nothing while the keyframe before is near where the link begins. Otherwise the link begins
  // there: position, velocity and attitude are integrated anew and so is their F; the noise stays.
  void operator()(const Keyframe& before, Keyframe* keyframe);

 private:
  RelinkConfig config_;
};

}  // namespace leonav
