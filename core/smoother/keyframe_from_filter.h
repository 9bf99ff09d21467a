// This function fills the smoother's keyframe from the filter after an epoch.
#pragma once
#include "core/filter/ekf.h"
#include "core/smoother/keyframe.h"

namespace leonav {

// Fills everything of `input` but its IMU block. `measurements` is the epoch as the filter's update
// has used it; nullptr: there was no update. `from` is the filter's state at the keyframe before
// and becomes that at this one. Begins the filter's process (EkfConfig::keep_process) to the next
// keyframe.
void keyframe_from_filter(std::uint64_t index, GpsTime time, const MeasurementEpoch* measurements,
                          FilterState* from, Ekf* filter, KeyframeInput* input);

}  // namespace leonav
