// A keyframe as the filter has treated its epoch.
#pragma once
#include "core/ekf/ekf.h"
#include "core/gnss/measurement.h"
#include "core/smoother/keyframe.h"

namespace leonav {

// To be called after filter->update(epoch), for epochs that are keyframes. `from`: the filter's
// state at the keyframe before (any before the first); becomes that at this one, where the process
// to the next keyframe begins. Fills all of `input` but the IMU's block and the sample before it.
// A measurement without a place among the keyframe's satellites is left out.
void keyframe_from_filter(const MeasurementEpoch& epoch, FilterState* from, Ekf* filter,
                          KeyframeInput* input);

}  // namespace leonav
