// This unit computes the motion of a recorded vehicle.
#pragma once
#include <vector>

#include "drivers/csv/truth_csv.h"
#include "tools/sim/motion/spline_motion.h"
#include "tools/sim/scenario/route_config.h"

namespace leonav::sim {

// Returns a smooth motion through the file's positions (see SmoothTrack).
//
// Roll, pitch and yaw are the file's if every row has them; otherwise the body points along its
// course and leans with its motion. Throws std::runtime_error if the track has too few points or a
// gap.
SplineMotion recorded_track(const RouteConfig& route);

}  // namespace leonav::sim
