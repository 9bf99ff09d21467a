// Where a satellite was when it sent what the receiver measured.
#pragma once
#include <Eigen/Core>

#include "core/gnss/measurement.h"
#include "core/gnss/satellite_catalog.h"

namespace leonav {

// Fills position, velocity, clock, sigma, age and source of `satellite` (its id is set) for a
// signal received at the receiver's `time_tag` with `pseudorange_m`. Pseudorange and tag carry the
// same receiver clock error, so tag minus pseudorange over c is the time of transmission by the
// satellite's clock, however wrong the receiver's is. `p_a_e` (zero: unknown) gives the flight time
// for the Earth's rotation; unknown, the pseudorange does, and 1 ms of clock error moves the
// satellite by 2 m. `*broadcast`: the elements that tell the group delays, or nullptr.
LookupStatus satellite_at_transmission(const SatelliteCatalog& catalog, GpsTime time_tag,
                                       double pseudorange_m, const Eigen::Vector3d& p_a_e,
                                       SatelliteInView* satellite, const Ephemeris** broadcast);

}  // namespace leonav
