#include "core/navigator/keyframe_maker.h"

#include "core/smoother/keyframe_from_filter.h"

namespace leonav {

void KeyframeMaker::add(const ImuBlock& block) {
  for (const ImuSample& sample : block) {
    if (block_->size() == block_->capacity()) whole_ = false;
    if (whole_) block_->push_back(sample);
    newest_ = sample;
  }
}

bool KeyframeMaker::is_due(const Ekf& ekf, GpsTime time) const {
  return !last_time_.is_set() || !ekf.process().continuous ||
         seconds_between(time, last_time_) >= interval_s_;
}

void KeyframeMaker::make(const EpochWork& work, const MeasurementEpoch* measurements,
                         MotionAid* motion, Ekf* ekf, KeyframeInput* keyframe) {
  keyframe_from_filter(work.index, work.time, measurements, &last_state_, ekf, keyframe);
  keyframe->block.clear();
  keyframe->before_block = before_block_;
  keyframe->instants = motion->instants();
  keyframe->block_whole = keyframe->linked && whole_ && motion->whole();
  motion->forget();
  if (keyframe->block_whole) keyframe->block = *block_;
  last_time_ = work.time;
  block_->clear();
  before_block_ = newest_;
  whole_ = true;
}

}  // namespace leonav
