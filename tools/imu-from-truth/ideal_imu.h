// What a perfect IMU on a track would deliver. On purpose nothing is shared with the mechanization
// that will integrate it, but the Earth's shape and gravity.
#pragma once
#include "core/ins/imu.h"
#include "smooth_track.h"

namespace leonav {

// Increments over (start, start + interval_ns]: rate and specific force in the turning body frame,
// from the track's derivatives in closed form, integrated by three-point Gauss-Legendre.
ImuSample ideal_sample(const SmoothTrack& track, GpsTime start, std::int64_t interval_ns);

}  // namespace leonav
