#include "tools/sim/signals/signal_path.h"

#include "core/gnss/propagation/shapiro.h"
#include "core/gnss/signals/signal.h"

namespace leonav::sim {

AntennaInstant antenna_at(const SplineMotion& motion, const Eigen::Vector3d& lever_arm_b,
                          const Eigen::Vector3d& tide_e, double t) {
  const MotionInstant now = motion.at(t);
  AntennaInstant antenna;
  antenna.t = t;
  antenna.C_eb = now.q_eb.toRotationMatrix();
  antenna.p_e = now.p_e + antenna.C_eb * lever_arm_b + tide_e;
  antenna.p_i = to_inertial(antenna.p_e, t);
  antenna.position = to_geodetic(antenna.p_e);
  return antenna;
}

SignalPath signal_path(const TrueSatellite& satellite, const AntennaInstant& antenna,
                       const Atmosphere& atmosphere) {
  SignalPath path;
  path.flight_s = 0.08;
  // Each round gains a factor v/c; three are enough for a nanometre.
  for (int i = 0; i < 4; ++i) {
    path.satellite = satellite.orbit.at(antenna.t - path.flight_s);
    path.flight_s = (path.satellite.p_i - antenna.p_i).norm() / kSpeedOfLight;
  }
  // The satellite's position is in ECEF of the instant of reception.
  const Eigen::Vector3d p_s_e = to_earth(path.satellite.p_i, antenna.t);
  path.direction = look_angles(p_s_e, antenna.p_e);
  const double clock = clock_s(satellite, antenna.t - path.flight_s);
  path.range_m = kSpeedOfLight * (path.flight_s - clock) + shapiro_delay_m(p_s_e, antenna.p_e) +
                 atmosphere.troposphere_m(antenna.t, antenna.position, path.direction);
  path.tecu =
      atmosphere.ionosphere().tecu(antenna.t, satellite.id, antenna.position, path.direction);
  return path;
}

}  // namespace leonav::sim
