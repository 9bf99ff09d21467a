// Interpolates tabulated precise positions and clocks of one satellite.
#pragma once
#include <Eigen/Core>

#include "core/gnss/precise_clock.h"
#include "core/gnss/satellite_state.h"
#include "core/time/gps_time.h"

namespace leonav {

struct OrbitNode {
  GpsTime time;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();  // m, ECEF at `time`
  double clock_s = 0.0;                           // NaN: none
  bool clock_event = false;                       // the clock was changed since the node before
  bool maneuver = false;                          // the orbit was changed since the node before
  bool clock_predicted = false, orbit_predicted = false;  // not from observations
};

// State at `time` from `count` nodes in order of time: positions by a polynomial through up to
// kPolynomialNodes nodes around `time`, after turning them into the inertial frame that coincides
// with ECEF at `time`, of the degree at which its terms are smallest; velocity by its derivative.
// Clock: `clock` where given, else linear between the two nodes around; plus the periodic
// relativistic term that these products leave out. False (and `*state` unchanged) where the nodes
// around are farther apart than `max_gap_s`, too few for a good polynomial, without clocks, where
// the orbit (or the nodes' clock, if that is used) was changed between them, or where `time` lies
// before the first or more than kOrbitExtrapolation after the last. `system` tells how clocks
// stray. Fills everything but `issue`.
bool precise_state(const OrbitNode* nodes, std::size_t count, GpsTime time, double max_gap_s,
                   System system, const PreciseClock* clock, SatelliteState* state);

// Degree 13: what eccentric Galileos need at nodes every 15 minutes.
inline constexpr std::size_t kPolynomialNodes = 14;
// Share of the last node interval by which a state may lie outside the nodes.
inline constexpr double kOrbitExtrapolation = 0.05;

}  // namespace leonav
