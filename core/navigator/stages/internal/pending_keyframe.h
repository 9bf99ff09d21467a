// PendingKeyframe collects what the smoother's next keyframe needs, from the filter and the IMU.
#pragma once
#include <memory>

#include "core/filter/ekf.h"
#include "core/navigator/interface/stage_work.h"
#include "core/smoother/keyframe.h"
#include "core/vehicle/motion_aiding.h"

namespace leonav {

class PendingKeyframe {
 public:
  explicit PendingKeyframe(double interval_s) : interval_s_(interval_s) {}

  // Adds the IMU samples since the epoch before; to be called for every epoch, keyframe or not.
  void add(const ImuBlock& block);
  // True if an epoch is to be a keyframe: not too soon after the last one, unless the filter has
  // started over since then.
  bool is_due(const Ekf& ekf, GpsTime time) const;
  // Writes the keyframe and begins the filter's process to the next one. `measurements`: the epoch
  // as the filter's update used it; nullptr: there was none. The keyframe takes the constraint
  // instants of `motion`.
  void make(const EpochWork& work, const MeasurementEpoch* measurements, MotionAiding* motion,
            Ekf* ekf, KeyframeInput* keyframe);

 private:
  double interval_s_;
  GpsTime last_time_;
  FilterState last_state_;  // the filter's, at the last keyframe
  // The IMU samples since the last keyframe, incomplete if there was no room.
  std::unique_ptr<ImuBlock> block_ = std::make_unique<ImuBlock>();
  ImuSample before_block_, newest_;
  bool block_complete_ = true;
};

}  // namespace leonav
