// This unit computes the path from a satellite's antenna to the receiver's, without noise.
#pragma once
#include "core/gnss/measurement/look_angles.h"
#include "tools/sim/motion/spline_motion.h"
#include "tools/sim/signals/atmosphere.h"
#include "tools/sim/sky/true_sky.h"

namespace leonav::sim {

// The receiver's antenna at one instant.
struct AntennaInstant {
  double t = 0.0;            // true time of reception, s from the start
  Eigen::Vector3d p_e, p_i;  // tides included
  Geodetic position;
  Eigen::Matrix3d C_eb;
};
// Returns the antenna at time `t`.
AntennaInstant antenna_at(const SplineMotion& motion, const Eigen::Vector3d& lever_arm_b,
                          const Eigen::Vector3d& tide_e, double t);

// The path of one signal.
struct SignalPath {
  double range_m = 0.0;  // all that is common to the frequencies, with the satellite's clock
  double tecu = 0.0;     // slant
  LookAngles direction;
  OrbitState satellite;  // at the time of transmission
  double flight_s = 0.0;
};
// Returns the path: light time in the inertial frame, Shapiro delay, troposphere.
SignalPath signal_path(const TrueSatellite& satellite, const AntennaInstant& antenna,
                       const Atmosphere& atmosphere);

}  // namespace leonav::sim
