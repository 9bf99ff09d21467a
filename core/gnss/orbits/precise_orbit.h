// This unit interpolates the tabulated precise positions and clocks of one satellite.
#pragma once
#include <Eigen/Core>

#include "core/base/gps_time.h"
#include "core/gnss/orbits/internal/precise_clock.h"
#include "core/gnss/orbits/satellite_state.h"

namespace leonav {

// One tabulated state of a satellite.
struct OrbitNode {
  GpsTime time;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();  // m, ECEF at `time`
  double clock_s = 0.0;                           // NaN: none
  bool clock_event = false;                       // the clock was changed since the node before
  bool maneuver = false;                          // the orbit was changed since the node before
  bool clock_predicted = false, orbit_predicted = false;  // not from observations
};

// Computes the state at `time` from `count` nodes in order of time.
//
// Position: a polynomial through up to kPolynomialNodes nodes around `time`, after turning them
// into the inertial frame that coincides with ECEF at `time`, of the degree at which its terms are
// smallest. Velocity: the derivative of the polynomial. Clock: `clock` where given, else linear
// between the two nodes around `time`, plus the periodic relativistic term that these products
// leave out. `system` selects the random walk of the clock.
//
// Returns false (and leaves `*state` unchanged) where the nodes around `time` are farther apart
// than `max_gap_s`, too few for a good polynomial or without clocks; where the orbit (or the nodes'
// clock, if that is used) was changed between them; or where `time` lies before the first node or
// more than kOrbitExtrapolation after the last. It sets every member but `issue`; the
// position is the centre of mass.
bool precise_state(const OrbitNode* nodes, std::size_t count, GpsTime time, double max_gap_s,
                   System system, const PreciseClock* clock, SatelliteState* state);

// Degree 13 is needed for Galileo satellites in eccentric orbits with nodes every 15 minutes.
inline constexpr std::size_t kPolynomialNodes = 14;
// A state may lie outside the nodes by this share of the last node interval.
inline constexpr double kOrbitExtrapolation = 0.05;

}  // namespace leonav
