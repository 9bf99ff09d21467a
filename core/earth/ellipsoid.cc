#include "core/earth/ellipsoid.h"

#include <cmath>

namespace leonav {

double prime_vertical_radius(double latitude) {
  const double s = std::sin(latitude);
  return kEarthSemiMajorAxis / std::sqrt(1.0 - kEarthEccentricitySquared * s * s);
}

double meridian_radius(double latitude) {
  const double s = std::sin(latitude);
  const double d = 1.0 - kEarthEccentricitySquared * s * s;
  return kEarthSemiMajorAxis * (1.0 - kEarthEccentricitySquared) / (d * std::sqrt(d));
}

// The conversion is Bowring's formula (Survey Review 23, 1976) on the sine and cosine of the
// reduced latitude. One step is a Newton step on the footpoint equation (Fukushima, J. Geodesy 79,
// 2006), so repeating the step until nothing changes makes the result exact; near the Earth two
// steps suffice.
Geodetic to_geodetic(const Eigen::Vector3d& p_e) {
  constexpr double a = kEarthSemiMajorAxis, e2 = kEarthEccentricitySquared;
  constexpr double b = a * (1.0 - kEarthFlattening);
  constexpr int kMaxSteps = 20;  // reached only within some 100 km of the Earth's centre
  const double p = std::hypot(p_e.x(), p_e.y());
  const double z = p_e.z();
  if (p == 0.0 && z == 0.0) return {0.0, 0.0, -a};

  double s = z, c = p * (1.0 - kEarthFlattening);  // reduced latitude of the point itself
  double norm = std::hypot(s, c);
  s /= norm;
  c /= norm;
  double sin_latitude = 0.0, cos_latitude = 1.0;
  for (int step = 0; step < kMaxSteps; ++step) {
    sin_latitude = z + e2 / (1.0 - e2) * b * s * s * s;
    cos_latitude = std::max(p - e2 * a * c * c * c, 0.0);  // negative only inside the evolute
    norm = std::hypot(sin_latitude, cos_latitude);
    if (norm == 0.0) return {0.0, std::atan2(p_e.y(), p_e.x()), p - a};
    sin_latitude /= norm;
    cos_latitude /= norm;
    const double old_s = s, old_c = c;
    s = (1.0 - kEarthFlattening) * sin_latitude;
    c = cos_latitude;
    norm = std::hypot(s, c);
    s /= norm;
    c /= norm;
    if (std::abs(s * old_c - c * old_s) < 1e-15) break;
  }
  // The height is exact to second order in the remaining error of the latitude.
  const double height =
      p * cos_latitude + z * sin_latitude - a * std::sqrt(1.0 - e2 * sin_latitude * sin_latitude);
  const double longitude = p > 0.0 ? std::atan2(p_e.y(), p_e.x()) : 0.0;
  return {std::atan2(sin_latitude, cos_latitude), longitude, height};
}

Eigen::Vector3d to_ecef(const Geodetic& geodetic) {
  const double sin_latitude = std::sin(geodetic.latitude);
  const double cos_latitude = std::cos(geodetic.latitude);
  const double n = prime_vertical_radius(geodetic.latitude);
  const double p = (n + geodetic.height) * cos_latitude;
  return {p * std::cos(geodetic.longitude), p * std::sin(geodetic.longitude),
          (n * (1.0 - kEarthEccentricitySquared) + geodetic.height) * sin_latitude};
}

Eigen::Matrix3d rotation_ecef_to_ned(const Geodetic& geodetic) {
  const double sb = std::sin(geodetic.latitude), cb = std::cos(geodetic.latitude);
  const double sl = std::sin(geodetic.longitude), cl = std::cos(geodetic.longitude);
  Eigen::Matrix3d C_ne;
  C_ne << -sb * cl, -sb * sl, cb,  //
      -sl, cl, 0.0,                //
      -cb * cl, -cb * sl, -sb;
  return C_ne;
}

}  // namespace leonav
