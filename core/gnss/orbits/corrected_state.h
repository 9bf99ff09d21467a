// This unit defines a satellite's state from broadcast elements with real-time corrections, and
// carries it on for some seconds.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "core/base/gps_time.h"
#include "core/gnss/orbits/satellite_state.h"
#include "core/gnss/signals/satellite.h"

namespace leonav {

// State of a satellite at one instant, as a correction service gives it.
struct CorrectedState {
  SatelliteId satellite;
  GpsTime time;                                   // instant that the state holds at
  GpsTime corrected_at;                           // reference time of the clock's correction
  GpsTime orbit_corrected_at;                     // reference time of the orbit's correction
  std::uint16_t issue = 0;                        // Ephemeris::issue of the corrected elements
  bool at_antenna = true;                         // p_e: antenna phase centre, or centre of mass
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();  // m, ECEF at `time`
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();  // m/s, relative to the rotating Earth
  double clock_s = 0.0;      // relativistic eccentricity term included, as of broadcast clocks
  double clock_drift = 0.0;  // s/s, that term included
  double sigma_m = 0.0;      // 1 sigma of orbit and clock along the line of sight at corrected_at
};

// Returns whether the values are those of a satellite: finite, above the ground and below 1e8 m,
// times set, a clock within 0.1 s, a sigma of at most 1 km.
bool is_sane(const CorrectedState& state);

// Who made the corrections: SSR provider, solution, and issue of the data (IOD SSR).
struct CorrectionSource {
  std::uint16_t provider = 0;
  std::uint8_t solution = 0, issue = 0;
  friend bool operator==(const CorrectionSource&, const CorrectionSource&) = default;
};

// No correction of an orbit holds for longer; services give seconds to some minutes, HAS an hour.
inline constexpr double kLongestOrbitAge_s = 3600.0;

// A state is not carried further than this: what the gravity model leaves out (Moon, Sun, J3 and
// higher: below 1e-5 m/s^2) comes to 2 cm then, and to 2 mm after 20 s.
inline constexpr double kLongestCarry_s = 60.0;

// Computes the state at `time`: the orbit in the field of the Earth's mass and J2, the clock
// linearly. sigma_change_m is the random walk of the satellite's clock since `corrected_at`. The
// source is kPrecise; `issue` is not set. Precondition: `time` is within kLongestCarry_s of
// state.time.
SatelliteState carried_state(const CorrectedState& state, GpsTime time);

}  // namespace leonav
