// Ionospheric code delay after Klobuchar's model (IS-GPS-200, 20.3.3.5.2.5).
#pragma once
#include "core/earth/ellipsoid.h"
#include "core/gnss/ephemeris.h"
#include "core/gnss/look_angles.h"
#include "core/time/gps_time.h"

namespace leonav {

// What is used where no coefficients have been received: a set that GPS broadcast at medium solar
// activity (2004-01-01). Its error may reach the delay itself; the caller widens its sigma.
const KlobucharModel& default_klobuchar();

// Slant delay of the code in metres, to be subtracted from a pseudorange at `frequency_hz` (the
// carrier phase is advanced by as much). If `model` is not valid, default_klobuchar() stands in.
// Zero for a satellite below the horizon or a frequency that is not positive.
double klobuchar_delay_m(const KlobucharModel& model, const Geodetic& antenna,
                         const LookAngles& direction, GpsTime time, double frequency_hz);

}  // namespace leonav
