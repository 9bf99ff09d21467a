// This unit computes the orientation of a satellite. It determines the antenna's offset from the
// centre of mass to the phase centre, and the phase wind-up.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "core/gnss/signals/satellite.h"

namespace leonav {

// Rule by which a satellite is oriented.
enum class AttitudeLaw : std::uint8_t {
  // Z points to the Earth's centre, Y along the solar panels' axis, X to the Sun's side (the axes
  // of the IGS: Montenbruck et al. 2015, Adv. Space Res. 56, 1015).
  kYawSteering = 0,
  // Z points to the Earth's centre, Y against the orbit normal, X along the flight.
  kOrbitNormal,
};

// Returns the law of a satellite. GPS, Galileo and BeiDou steer yaw, except geostationary BeiDou
// satellites, which keep to the orbit normal. LEO satellites follow `leo`, because builders of low
// satellites have no common law. BeiDou-2 satellites that leave yaw steering when the Sun is near
// their orbital plane are not distinguished.
AttitudeLaw attitude_law(SatelliteId satellite, AttitudeLaw leo);

// Returns C_es: its columns are the body's X, Y, Z axes in ECEF. Positions are in m, `v_sat_e` in
// m/s, both ECEF. Where Sun, satellite and Earth are in line within 1e-6 rad, or the Sun's position
// is not finite, yaw steering gives the axes of the orbit normal; without any velocity the result
// has Z to the Earth and an arbitrary X. The satellite's real turn at noon and midnight, which
// takes up to half an hour, is not modelled.
Eigen::Matrix3d satellite_axes(const Eigen::Vector3d& p_sat_e, const Eigen::Vector3d& v_sat_e,
                               const Eigen::Vector3d& p_sun_e, AttitudeLaw law);

}  // namespace leonav
