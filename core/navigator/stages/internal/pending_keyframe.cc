#include "core/navigator/stages/internal/pending_keyframe.h"

#include "core/smoother/keyframe_from_filter.h"

namespace leonav {

void PendingKeyframe::add(const ImuBlock& block) {
  for (const ImuSample& sample : block) {
    if (block_->size() == block_->capacity()) block_complete_ = false;
    if (block_complete_) block_->push_back(sample);
    newest_ = sample;
  }
}

bool PendingKeyframe::is_due(const Ekf& ekf, GpsTime time) const {
  if (!ekf.initialized()) return false;  // the samples are kept for the next keyframe
  return !last_time_.is_set() || !ekf.estimate().process().continuous ||
         seconds_between(time, last_time_) >= interval_s_;
}

void PendingKeyframe::make(const EpochWork& work, const MeasurementEpoch* measurements,
                           MotionAiding* motion, Ekf* ekf, KeyframeInput* keyframe) {
  keyframe_from_filter(work.index, work.time, measurements, &last_state_, ekf, keyframe);
  keyframe->ends_window = ends_window_;
  ends_window_ = false;
  keyframe->block.clear();
  keyframe->sample_before_block = before_block_;
  keyframe->instants = motion->instants();
  keyframe->block_complete = keyframe->valid && block_complete_ && motion->instants_complete();
  motion->clear_instants();
  if (keyframe->block_complete) keyframe->block = *block_;
  last_time_ = work.time;
  block_->clear();
  before_block_ = newest_;
  block_complete_ = true;
}

}  // namespace leonav
