// This unit defines the WGS84 ellipsoid and converts between ECEF and geodetic coordinates.
// Constants are those of NIMA TR8350.2, third edition. Lengths are in m, angles in rad; n is the
// local frame with axes north, east, down.
#pragma once
#include <Eigen/Core>

namespace leonav {

inline constexpr double kEarthSemiMajorAxis = 6'378'137.0;  // m
inline constexpr double kEarthFlattening = 1.0 / 298.257223563;
inline constexpr double kEarthEccentricitySquared = kEarthFlattening * (2.0 - kEarthFlattening);
inline constexpr double kEarthRotationRate = 7.292115e-5;              // rad/s
inline constexpr double kEarthGravitationalConstant = 3.986004418e14;  // m^3/s^2

// Geodetic coordinates on the WGS84 ellipsoid.
struct Geodetic {
  double latitude = 0.0;   // rad
  double longitude = 0.0;  // rad, (-pi, pi]
  double height = 0.0;     // m above the ellipsoid
};

// Converts an ECEF position (m). The result is exact to below a nanometre from the Earth's core to
// beyond geostationary orbit; p_e == 0 gives the point (0, 0, -a).
Geodetic to_geodetic(const Eigen::Vector3d& p_e);
// Converts geodetic coordinates to an ECEF position, m.
Eigen::Vector3d to_ecef(const Geodetic& geodetic);

// Returns C_ne, which rotates ECEF vectors into north, east, down at `geodetic`; its transpose is
// C_en.
Eigen::Matrix3d rotation_ecef_to_ned(const Geodetic& geodetic);

double meridian_radius(double latitude);        // radius of curvature R_M, m
double prime_vertical_radius(double latitude);  // radius of curvature R_N, m

}  // namespace leonav
