// How a satellite stands in space: what carries its antenna's offset from the centre of mass to the
// phase centre, and turns its phase (wind-up).
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "core/gnss/satellite.h"

namespace leonav {

enum class AttitudeLaw : std::uint8_t {
  // Z to the Earth's centre, Y along the solar panels' axis, X on the Sun's side (the axes of the
  // IGS: Montenbruck et al. 2015, Adv. Space Res. 56, 1015).
  kYawSteering = 0,
  // Z to the Earth's centre, Y against the orbit's normal, X along the flight.
  kOrbitNormal,
};

// GPS, Galileo, BeiDou: yaw steering, but for geostationary BeiDou satellites, which keep to the
// orbit's normal. LEO: `leo`, as builders of low satellites have no common law. BeiDou-2 satellites
// that leave yaw steering when the Sun is near their orbital plane are not told apart.
AttitudeLaw attitude_law(SatelliteId satellite, AttitudeLaw leo);

// Columns: the body's X, Y, Z axes in ECEF (C_es). Positions m; `v_sat_e` m/s in ECEF. Where Sun,
// satellite and Earth stand in line within 1e-6 rad, or the Sun's place is not finite, yaw steering
// gives the axes of the orbit's normal; without any velocity, some axes with Z to the Earth. The
// satellite's real turn at noon and midnight, which takes up to half an hour, is not modelled.
Eigen::Matrix3d satellite_axes(const Eigen::Vector3d& p_sat_e, const Eigen::Vector3d& v_sat_e,
                               const Eigen::Vector3d& p_sun_e, AttitudeLaw law);

}  // namespace leonav
