#include "core/gnss/orbits/corrected_state.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/gnss/orbits/internal/precise_clock.h"

namespace leonav {
namespace {

constexpr double kJ2 = 1.08263e-3;
constexpr double kEquatorialRadius = 6378137.0;  // m

// Acceleration in an inertial frame whose Z is the Earth's axis.
Eigen::Vector3d gravitation(const Eigen::Vector3d& p) {
  const double r = p.norm();
  const double mu_r3 = kEarthGravitationalConstant / (r * r * r);
  const double z2 = square(p.z() / r);
  const double oblate = 1.5 * kJ2 * square(kEquatorialRadius / r);
  return -mu_r3 * Eigen::Vector3d(p.x() * (1.0 + oblate * (1.0 - 5.0 * z2)),
                                  p.y() * (1.0 + oblate * (1.0 - 5.0 * z2)),
                                  p.z() * (1.0 + oblate * (3.0 - 5.0 * z2)));
}

Eigen::Vector3d earth_rotation_cross(const Eigen::Vector3d& p) {
  return {-kEarthRotationRate * p.y(), kEarthRotationRate * p.x(), 0.0};
}

}  // namespace

bool is_sane(const CorrectedState& state) {
  if (!is_valid(state.satellite) || state.time.nanoseconds() <= 0) return false;
  if (state.corrected_at.nanoseconds() <= 0 || state.orbit_corrected_at.nanoseconds() <= 0) {
    return false;
  }
  const double radius = state.p_e.norm(), speed = state.v_e.norm();  // comparisons fail for NaN
  return radius > 6.4e6 && radius < 1e8 && speed < 1e4 && std::abs(state.clock_s) < 0.1 &&
         std::abs(state.clock_drift) < 1e-6 && state.sigma_m > 0.0 && state.sigma_m < 1e3;
}

SatelliteState carried_state(const CorrectedState& from, GpsTime time) {
  const double dt = seconds_between(time, from.time);
  // One step of Runge and Kutta of fourth order in the frame that equals ECEF at from.time.
  const Eigen::Vector3d p = from.p_e, v = from.v_e + earth_rotation_cross(from.p_e);
  const Eigen::Vector3d a1 = gravitation(p);
  const Eigen::Vector3d a2 = gravitation(p + 0.5 * dt * v);
  const Eigen::Vector3d a3 = gravitation(p + 0.5 * dt * v + 0.25 * dt * dt * a1);
  const Eigen::Vector3d a4 = gravitation(p + dt * v + 0.5 * dt * dt * a2);
  const double angle = kEarthRotationRate * dt;
  SatelliteState state;
  state.p_e = rotate_about_z(p + dt * v + dt * dt / 6.0 * (a1 + a2 + a3), angle);
  const Eigen::Vector3d v_inertial =
      rotate_about_z(v + dt / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4), angle);
  state.v_e = v_inertial - earth_rotation_cross(state.p_e);
  state.clock_s = from.clock_s + from.clock_drift * dt;
  state.clock_drift = from.clock_drift;
  const double age_s = std::abs(seconds_between(time, from.corrected_at));
  const double change_m2 = square(clock_walk(from.satellite.system)) * age_s;
  state.sigma_change_m = std::sqrt(change_m2);
  state.sigma_m = std::sqrt(square(from.sigma_m) + change_m2);
  state.age_s = age_s;
  state.source = OrbitSource::kPrecise;
  state.at_antenna = from.at_antenna;
  return state;
}

}  // namespace leonav
