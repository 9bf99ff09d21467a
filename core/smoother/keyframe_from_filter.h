// From the filter after an epoch to the smoother's keyframe.
#pragma once
#include "core/filter/ekf.h"
#include "core/smoother/keyframe.h"

namespace leonav {

// Everything of `input` but its IMU block. `measurements`: the epoch as the filter's update has had
// it; nullptr: there was no update. `from`: the filter's state at the keyframe before; becomes that
// at this one. Begins the filter's process (EkfConfig::keep_process) to the next keyframe.
void keyframe_from_filter(std::uint64_t index, GpsTime time, const MeasurementEpoch* measurements,
                          FilterState* from, Ekf* filter, KeyframeInput* input);

}  // namespace leonav
