// From the filter after an epoch to the smoother's keyframe.
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

  // Of every epoch, keyframe or not: the IMU since the epoch before.
  void add(const ImuBlock& block);
  // Whether an epoch is to be a keyframe: not too soon after the last one, unless the filter has
  // started over since.
  bool is_due(const Ekf& ekf, GpsTime time) const;
  // Writes it, and begins the filter's process to the next one. `measurements`: the epoch as the
  // filter's update had it; nullptr: there was none.
  // `motion`: its instants go into it.
  void make(const EpochWork& work, const MeasurementEpoch* measurements, MotionAiding* motion,
            Ekf* ekf, KeyframeInput* keyframe);

 private:
  double interval_s_;
  GpsTime last_time_;
  FilterState last_state_;  // the filter's, then
  // Since the last keyframe. Not whole: it was too long to be kept.
  std::unique_ptr<ImuBlock> block_ = std::make_unique<ImuBlock>();
  ImuSample before_block_, newest_;
  bool block_complete_ = true;
};

}  // namespace leonav
