// PendingKeyframe collects the IMU samples of the next keyframe and fills it from the filter.
#pragma once
#include <memory>

#include "core/filter/ekf.h"
#include "core/navigator/interface/stage_work.h"
#include "core/smoother/keyframe.h"
#include "core/vehicle/motion_aiding.h"

namespace leonav {

// PendingKeyframe lives in the GNSS stage. Allocates when constructed, not after.
class PendingKeyframe {
 public:
  // `interval_s` is the smallest interval between keyframes.
  explicit PendingKeyframe(double interval_s) : interval_s_(interval_s) {}

  // Adds the IMU samples since the epoch before; call it at every epoch, keyframe or not.
  void add(const ImuBlock& block);
  // Returns whether an epoch is to be a keyframe: the filter has a state, and it is not too soon
  // after the last one, or the filter has started over since.
  bool is_due(const Ekf& ekf, GpsTime time) const;
  // Marks the next keyframe as one that ends the smoother's window (KeyframeInput::ends_window).
  void end_window() { ends_window_ = true; }
  bool ends_window() const { return ends_window_; }
  // Fills `keyframe` and begins the filter's process to the next one. `measurements` is the epoch
  // as the filter's update used it; nullptr: there was no update. The constraint instants of
  // `motion` move into the keyframe.
  void make(const EpochWork& work, const MeasurementEpoch* measurements, MotionAiding* motion,
            Ekf* ekf, KeyframeInput* keyframe);

 private:
  double interval_s_;
  GpsTime last_time_;
  FilterState last_state_;  // the filter's at last_time_
  // Samples since the last keyframe. Not complete if they exceeded the capacity.
  std::unique_ptr<ImuBlock> block_ = std::make_unique<ImuBlock>();
  ImuSample before_block_, newest_;  // the last sample before the block, and of all
  bool block_complete_ = true;
  bool ends_window_ = false;
};

}  // namespace leonav
