// This unit computes the output of a perfect IMU in a given motion. On purpose it shares nothing
// with the mechanization that will integrate the output, except the Earth's shape and gravity.
#pragma once
#include "core/inertial/strapdown/imu.h"
#include "tools/sim/motion/spline_motion.h"

namespace leonav {

// Returns the increments over (start, start + interval_ns].
//
// Rate and specific force in the rotating body frame follow from the motion's derivatives in closed
// form and are integrated by three-point Gauss-Legendre.
ImuSample ideal_sample(const SplineMotion& motion, GpsTime start, std::int64_t interval_ns);

}  // namespace leonav
