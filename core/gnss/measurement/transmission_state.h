// This unit computes the state of a satellite when it transmitted the measured signal.
#pragma once
#include <Eigen/Core>

#include "core/gnss/measurement/measurement.h"
#include "core/gnss/orbits/ephemeris_store.h"

namespace leonav {

// Sets position, velocity, clock, sigma, age and source of `satellite` (whose id is set) for a
// signal received at the receiver's `time_tag` with `pseudorange_m`. Pseudorange and time tag
// contain the same receiver clock error, so tag minus pseudorange over c is the time of
// transmission by the satellite's clock, whatever the receiver's clock error. `p_a_e` (ECEF, m;
// zero: unknown) gives the flight time for the Earth's rotation. Without it the pseudorange does,
// and 1 ms of clock error moves the satellite by 2 m. `*broadcast` becomes the elements with the
// group delays, or nullptr.
LookupStatus satellite_at_transmission(const EphemerisStore& ephemeris_store, GpsTime time_tag,
                                       double pseudorange_m, const Eigen::Vector3d& p_a_e,
                                       SatelliteInView* satellite, const Ephemeris** broadcast);

}  // namespace leonav
