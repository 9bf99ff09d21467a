// Predicts the filter over a block of IMU samples, held by what the vehicle's way of moving tells.
#pragma once
#include <boost/container/static_vector.hpp>
#include <span>

#include "core/capacity.h"
#include "core/ekf/ekf.h"
#include "core/ins/standstill_detector.h"

namespace leonav {

struct MotionAidConfig {
  MotionConstraintConfig constraints;
  StandstillConfig standstill;
  bool enabled() const { return constraints.non_holonomic || constraints.zero_velocity; }
};

// Constraints act at instants a fixed interval of GPS time apart, wherever a sample is, so that a
// replay meets the same ones.
class MotionAid {
 public:
  explicit MotionAid(const MotionAidConfig& config)
      : config_(config), detector_(config.standstill) {}

  // As Ekf::predict.
  void predict(std::span<const ImuSample> block, GpsTime time, Ekf* ekf);
  bool standing() const { return standing_; }
  // Since the last call of forget(); as many as have a place.
  const ConstraintInstants& instants() const { return instants_; }
  bool whole() const { return whole_; }  // none was left out for want of a place
  void forget();

 private:
  void constrain(Ekf* ekf);

  MotionAidConfig config_;
  StandstillDetector detector_;
  ConstraintInstants instants_;
  MotionMeasurements measurements_;
  GpsTime next_;
  bool standing_ = false, whole_ = true;
};

}  // namespace leonav
