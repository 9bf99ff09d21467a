// Interpolates tabulated precise positions and clocks of one satellite.
#pragma once
#include <Eigen/Core>

#include "core/gnss/satellite_state.h"
#include "core/time/gps_time.h"

namespace leonav {

struct OrbitNode {
  GpsTime time;
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();  // m, ECEF at `time`
  double clock_s = 0.0;                           // NaN: none
};

// State at `time` from `count` nodes in order of time: positions by a polynomial through up to ten
// nodes around `time`, after turning them into the inertial frame that coincides with ECEF at
// `time`; velocity by its derivative; clock linear between the two nodes around, plus the periodic
// relativistic term that these products leave out. False (and `*state` unchanged) where the nodes
// around are farther apart than `max_gap_s`, too few for a good polynomial, without clocks, or
// where `time` lies before the first or more than kOrbitExtrapolation after the last.
bool precise_state(const OrbitNode* nodes, std::size_t count, GpsTime time, double max_gap_s,
                   SatelliteState* state);

// Share of the last node interval by which a state may lie outside the nodes.
inline constexpr double kOrbitExtrapolation = 0.05;

}  // namespace leonav
