// This unit models the ionospheric code delay by Klobuchar (IS-GPS-200, 20.3.3.5.2.5).
#pragma once
#include "core/base/gps_time.h"
#include "core/earth/ellipsoid.h"
#include "core/gnss/measurement/look_angles.h"
#include "core/gnss/orbits/ephemeris.h"

namespace leonav {

// Returns the coefficients used where none have been received: a set that GPS broadcast at medium
// solar activity (2004-01-01). Its error may reach the delay itself; the caller raises its sigma.
const KlobucharModel& default_klobuchar();

// Returns the slant delay of the code in metres, to be subtracted from a pseudorange at
// `frequency_hz` (the carrier phase is advanced by as much). If `model` is not valid,
// default_klobuchar() replaces it. The delay is zero for a satellite below the horizon or a
// frequency that is not positive.
double klobuchar_delay_m(const KlobucharModel& model, const Geodetic& antenna,
                         const LookAngles& direction, GpsTime time, double frequency_hz);
// Returns the delay of a code on L1 at the zenith by `model`, m, as klobuchar_delay_m() does.
double zenith_ionosphere_m(const KlobucharModel& model, const Geodetic& antenna, GpsTime time);

}  // namespace leonav
