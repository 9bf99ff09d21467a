// What a perfect IMU in a motion would deliver. On purpose nothing is shared with the mechanization
// that will integrate it, but the Earth's shape and gravity.
#pragma once
#include "core/ins/imu.h"
#include "tools/motion/spline_motion.h"

namespace leonav {

// Increments over (start, start + interval_ns]: rate and specific force in the turning body frame,
// from the motion's derivatives in closed form, integrated by three-point Gauss-Legendre.
ImuSample ideal_sample(const SplineMotion& motion, GpsTime start, std::int64_t interval_ns);

}  // namespace leonav
