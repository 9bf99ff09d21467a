// This unit defines a satellite's position, velocity and clock at one instant, and computes them
// from broadcast elements.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "core/gnss/orbits/ephemeris.h"

namespace leonav {

// Product that gave a satellite state.
enum class OrbitSource : std::uint8_t { kNone = 0, kBroadcast = 1, kPrecise = 2 };

// State of one satellite at one instant, from any product.
struct SatelliteState {
  // m, ECEF at `time`; which point of the satellite: `at_antenna`
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();  // m/s, relative to the rotating Earth
  double clock_s =
      0.0;  // satellite clock minus system time, relativistic eccentricity term included
  double clock_drift = 0.0;  // s/s, relativistic eccentricity term included
  double sigma_m = 0.0;      // 1 sigma of orbit and clock together along the line of sight
  // The part of sigma_m that varies from epoch to epoch (interpolation); the rest is constant over
  // an arc.
  double sigma_change_m = 0.0;
  double age_s = 0.0;       // |instant - reference time of the product|
  std::uint32_t issue = 0;  // a new value means other elements and a step of their error; 0: none
  OrbitSource source = OrbitSource::kNone;
  bool at_antenna = false;       // p_e: antenna phase centre (broadcast), or centre of mass
  bool clock_from_file = false;  // precise: from a clock file, finer than the clocks of the orbits
};

// Computes orbit and clock from broadcast elements at `time` (system time of transmission).
//
// Position: IS-GPS-200 table 20-IV; BDS-SIS-ICD-B1I table 5-11 (geostationary satellites too),
// BDS-SIS-ICD-B1C table 7-9; Galileo OS-SIS-ICD 5.1.1. Velocity: analytic derivative. Clock:
// includes -2 r.v/c^2 (of the Kepler orbit) and no group delay. `ephemeris` must be sane (is_sane);
// the caller checks age and health.
SatelliteState broadcast_state(const Ephemeris& ephemeris, GpsTime time);

// Returns whether the elements are within physical bounds: finite, eccentricity below 0.2 (two
// Galileo satellites have 0.16), semi-major axis plausible, times set. Every message must pass this
// before it is stored, so that hostile input cannot do harm.
bool is_sane(const Ephemeris& ephemeris);

}  // namespace leonav
