// What a perfect IMU on a track would deliver. On purpose nothing is shared with the mechanization
// that will integrate it, but the Earth's shape and gravity.
#pragma once
#include "core/ins/imu.h"
#include "smooth_track.h"

namespace leonav {

// Increments over (start, start + interval_ns]. Rotation: attitude against i differenced over
// sub-steps. Velocity: specific force integrated in the turning body frame by Gauss-Legendre.
ImuSample ideal_sample(const SmoothTrack& track, GpsTime start, std::int64_t interval_ns);

}  // namespace leonav
