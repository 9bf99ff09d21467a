// Where a satellite is and what its clock says, whatever product that comes from.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "core/gnss/ephemeris.h"

namespace leonav {

enum class OrbitSource : std::uint8_t { kNone = 0, kBroadcast = 1, kPrecise = 2 };

struct SatelliteState {
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();  // m, ECEF at the instant asked for; broadcast:
                                                  // antenna phase centre, precise: centre of mass
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();  // m/s, relative to the rotating Earth
  double clock_s =
      0.0;  // satellite clock minus system time, relativistic eccentricity term included
  double clock_drift = 0.0;     // s/s, likewise
  double sigma_m = 0.0;         // 1 sigma of orbit and clock together along the line of sight
  double sigma_change_m = 0.0;  // the part of it that is another from epoch to epoch (error of the
                                // interpolation); the rest passes for a carrier arc's constant
  double age_s = 0.0;           // |instant - reference time of the product|
  std::uint32_t issue = 0;      // another one, other elements: their error steps. 0: none
  OrbitSource source = OrbitSource::kNone;
  bool clock_of_file = false;  // precise: from a clock file, finer than the clocks of the orbits
};

// Orbit and clock from broadcast elements at `time` (system time of transmission). Position as in
// IS-GPS-200 table 20-IV, BDS-SIS-ICD-B1I table 5-11 (geostationary ones too), Galileo OS-SIS-ICD
// 5.1.1; velocity by analytic differentiation; clock with -2 r.v/c^2 (of the
// Kepler orbit) and without group delay.
// `ephemeris` must be sane (is_sane); the caller checks age and health.
SatelliteState broadcast_state(const Ephemeris& ephemeris, GpsTime time);

// Elements within physical bounds (finite, eccentricity < 0.2 (two Galileos have 0.16), semi-major
// axis plausible, times set): what a hostile message must pass before it is stored.
bool is_sane(const Ephemeris& ephemeris);

}  // namespace leonav
