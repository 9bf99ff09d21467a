// The motion of a vehicle that was recorded.
#pragma once
#include <vector>

#include "drivers/csv/truth_csv.h"
#include "tools/motion/spline_motion.h"
#include "tools/sim/scenario/route_config.h"

namespace leonav::sim {

// Through the file's positions, smoothed (see SmoothTrack). Roll, pitch and yaw are the file's
// where it has them in every row; otherwise the body points along its course and leans with its
// motion. Throws std::runtime_error where the track has too few points or a hole.
SplineMotion recorded_track(const RouteConfig& route);

}  // namespace leonav::sim
