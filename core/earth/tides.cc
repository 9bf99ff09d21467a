#include "core/earth/tides.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "core/earth/ellipsoid.h"

namespace leonav {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kLowestRadius = 6.0e6;  // m: nothing on the Earth's surface lies below
// IERS Conventions (2010), table 1.1 and section 7.1.1.
constexpr double kTideEarthRadius = 6'378'136.6;
constexpr double kSunMassRatio = 332'946.0482;
constexpr double kMoonMassRatio = 0.0123000371;
constexpr double kH3 = 0.292;
constexpr double kL3 = 0.015;

// Geocentric directions at the point, since the Conventions' angles are geocentric, not geodetic.
struct Place {
  double sin_latitude, cos_latitude, sin_longitude, cos_longitude, longitude;
  Eigen::Vector3d up, north, east;

  explicit Place(const Eigen::Vector3d& p_e) : up(p_e.normalized()) {
    const double rho = std::hypot(p_e.x(), p_e.y());
    sin_latitude = up.z();
    cos_latitude = rho / p_e.norm();
    cos_longitude = rho > 0.0 ? p_e.x() / rho : 1.0;
    sin_longitude = rho > 0.0 ? p_e.y() / rho : 0.0;
    longitude = std::atan2(sin_longitude, cos_longitude);
    east = {-sin_longitude, cos_longitude, 0.0};
    north = up.cross(east);
  }
  Eigen::Vector3d ecef(double up_m, double north_m, double east_m) const {
    return up_m * up + north_m * north + east_m * east;
  }
  double sin2() const { return 2.0 * sin_latitude * cos_latitude; }
  double cos2() const { return cos_latitude * cos_latitude - sin_latitude * sin_latitude; }
};

// Returns the displacement by one body without step 2: eqs. 7.5, 7.6, 7.8 to 7.11.
Eigen::Vector3d step_1(const Place& at, const Eigen::Vector3d& body, double mass_ratio) {
  const double distance = body.norm();
  if (!(distance > 10.0 * kTideEarthRadius)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d b = body / distance;
  const double ratio = kTideEarthRadius / distance;
  const double degree_2 = mass_ratio * kTideEarthRadius * ratio * ratio * ratio;
  const double degree_3 = degree_2 * ratio;

  const double legendre = 1.5 * at.sin_latitude * at.sin_latitude - 0.5;
  const double h2 = 0.6078 - 0.0006 * legendre;
  const double l2 = 0.0847 + 0.0002 * legendre;
  const double cosine = at.up.dot(b);
  Eigen::Vector3d d =
      degree_2 *
          (3.0 * l2 * cosine * b + (3.0 * (0.5 * h2 - l2) * cosine * cosine - 0.5 * h2) * at.up) +
      degree_3 *
          (kL3 * (7.5 * cosine * cosine - 1.5) * b +
           (2.5 * (kH3 - 3.0 * kL3) * cosine * cosine * cosine + 1.5 * (kL3 - kH3) * cosine) *
               at.up);

  // The body's direction is seen from the point's meridian. Its components towards the meridian and
  // to the east make the diurnal (z x, z y) and the semi-diurnal band (x^2 - y^2, 2 x y).
  const double along = b.x() * at.cos_longitude + b.y() * at.sin_longitude;
  const double across = b.y() * at.cos_longitude - b.x() * at.sin_longitude;
  const double diurnal_in = b.z() * along, diurnal_out = -b.z() * across;
  const double semi_in = along * along - across * across, semi_out = -2.0 * along * across;

  constexpr double kHImaginaryDiurnal = -0.0025, kLImaginaryDiurnal = -0.0007;
  constexpr double kHImaginarySemi = -0.0022, kLImaginarySemi = -0.0007;
  constexpr double kL1Diurnal = 0.0012, kL1Semi = 0.0024;
  const double s = at.sin_latitude, c = at.cos_latitude;
  const double up = -1.5 * kHImaginaryDiurnal * at.sin2() * diurnal_out -
                    0.75 * kHImaginarySemi * c * c * semi_out;
  const double north = -3.0 * kLImaginaryDiurnal * at.cos2() * diurnal_out +
                       1.5 * kLImaginarySemi * s * c * semi_out -
                       3.0 * kL1Diurnal * s * s * diurnal_in - 1.5 * kL1Semi * s * c * semi_in;
  const double east =
      -3.0 * kLImaginaryDiurnal * s * diurnal_in - 1.5 * kLImaginarySemi * c * semi_in +
      3.0 * kL1Diurnal * s * at.cos2() * diurnal_out - 1.5 * kL1Semi * s * s * c * semi_out;
  return d + degree_2 * at.ecef(up, north, east);
}

// Each term of step 2 has the multiples of tau's six arguments and the amplitudes in mm of the
// radial and transverse displacement, in and out of phase: IERS Conventions (2010), tables 7.3a and
// 7.3b.
struct Step2Term {
  int s, h, p, n, ps;
  double radial_in, radial_out, transverse_in, transverse_out;
};
constexpr std::array<Step2Term, 12> kDiurnal = {{
    {-2, 0, 1, 0, 0, -0.08, 0.00, -0.01, 0.01},
    {-1, 0, 0, -1, 0, -0.10, 0.00, 0.00, 0.00},
    {-1, 0, 0, 0, 0, -0.51, 0.00, -0.02, 0.03},
    {0, 0, 1, 0, 0, 0.06, 0.00, 0.00, 0.00},
    {1, -3, 0, 0, 1, -0.06, 0.00, 0.00, 0.00},
    {1, -2, 0, 0, 0, -1.23, -0.07, 0.06, 0.01},
    {1, 0, 0, -1, 0, -0.22, 0.01, 0.01, 0.00},
    {1, 0, 0, 0, 0, 12.00, -0.80, -0.67, -0.03},
    {1, 0, 0, 1, 0, 1.73, -0.12, -0.10, 0.00},
    {1, 1, 0, 0, -1, -0.50, -0.01, 0.03, 0.00},
    {1, 2, 0, 0, 0, -0.11, 0.01, 0.01, 0.00},
    {1, 0, 0, 2, 0, -0.04, 0.00, 0.00, 0.00},
}};
constexpr std::array<Step2Term, 5> kLongPeriod = {{
    {0, 0, 0, 1, 0, 0.47, 0.16, 0.23, 0.07},
    {0, 2, 0, 0, 0, -0.20, -0.11, -0.12, -0.05},
    {1, 0, -1, 0, 0, -0.11, -0.09, -0.08, -0.04},
    {2, 0, 0, 0, 0, -0.13, -0.15, -0.11, -0.07},
    {2, 0, 0, 1, 0, -0.05, -0.06, -0.05, -0.03},
}};

Eigen::Vector3d step_2(const Place& at, GpsTime time) {
  const double gps_days = seconds_between(time, GpsTime{}) / 86400.0;
  const double t = (gps_days + 51.184 / 86400.0 - 7300.5) / 36525.0;  // TT from J2000, centuries
  const double utc_days = gps_days - leap_seconds(time) / 86400.0;
  const double hour_angle = 360.0 * (utc_days - std::floor(utc_days));
  // Mean longitudes of date, in degrees: Moon, Sun, lunar perigee, minus the lunar node, solar
  // perigee.
  const double precession = 1.396971278 * t;
  const double s_mean = 218.31664563 + t * (481267.88194 - t * 0.0014663889);
  const double tau =
      reduced_angle(hour_angle + 280.4606184 + t * (36000.7700536 + t * 0.00038793) - s_mean);
  const double s = reduced_angle(s_mean + precession);
  const double h = reduced_angle(280.46645 + t * (36000.7697489 + t * 0.00030322222));
  const double p = reduced_angle(83.35324312 + t * (4069.01363525 - t * 0.01032172222));
  const double n = reduced_angle(234.95544499 + t * (1934.13626197 - t * 0.00207561111));
  const double ps = reduced_angle(282.93734098 + t * (1.71945766667 + t * 0.00045688889));
  const auto argument = [&](const Step2Term& k) {
    return k.s * s + k.h * h + k.p * p + k.n * n + k.ps * ps;
  };

  double up = 0.0, north = 0.0, east = 0.0;  // mm
  for (const Step2Term& k : kDiurnal) {      // eq. 7.12
    const double angle = tau + argument(k) + at.longitude;
    const double sine = std::sin(angle), cosine = std::cos(angle);
    up += (k.radial_in * sine + k.radial_out * cosine) * at.sin2();
    north += (k.transverse_in * sine + k.transverse_out * cosine) * at.cos2();
    east += (k.transverse_in * cosine - k.transverse_out * sine) * at.sin_latitude;
  }
  const double legendre = 1.5 * at.sin_latitude * at.sin_latitude - 0.5;
  for (const Step2Term& k : kLongPeriod) {  // eq. 7.13
    const double angle = argument(k);
    const double sine = std::sin(angle), cosine = std::cos(angle);
    up += (k.radial_in * cosine + k.radial_out * sine) * legendre;
    north += (k.transverse_in * cosine + k.transverse_out * sine) * at.sin2();
  }
  return 1e-3 * at.ecef(up, north, east);
}

}  // namespace

Eigen::Vector3d solid_earth_tide(const Eigen::Vector3d& p_e, GpsTime time, const SunMoon& bodies) {
  if (!(p_e.norm() > kLowestRadius)) return Eigen::Vector3d::Zero();
  const Place at(p_e);
  return step_1(at, bodies.sun_e, kSunMassRatio) + step_1(at, bodies.moon_e, kMoonMassRatio) +
         step_2(at, time);
}

Eigen::Vector3d ocean_loading_displacement(const Eigen::Vector3d& p_e, GpsTime time,
                                           const OceanLoading& loading) {
  // Each wave has its frequency in rad/s and the multiples of the mean longitudes of the Sun, the
  // Moon and the Moon's perigee and of a turn, in the order of OceanLoading::Constituent.
  struct Wave {
    double frequency, h, s, p, turns;
  };
  static constexpr std::array<Wave, OceanLoading::kConstituents> kWaves = {{
      {1.40519e-4, 2, -2, 0, 0.00},
      {1.45444e-4, 0, 0, 0, 0.00},
      {1.37880e-4, 2, -3, 1, 0.00},
      {1.45842e-4, 2, 0, 0, 0.00},
      {0.72921e-4, 1, 0, 0, 0.25},
      {0.67598e-4, 1, -2, 0, -0.25},
      {0.72523e-4, -1, 0, 0, -0.25},
      {0.64959e-4, 1, -3, 1, -0.25},
      {0.53234e-5, 0, 2, 0, 0.00},
      {0.26392e-5, 0, 1, -1, 0.00},
      {0.03982e-5, 2, 0, 0, 0.00},
  }};
  const double utc = seconds_between(time, GpsTime{}) - leap_seconds(time);
  const double day = std::floor(utc / 86400.0);
  const double second_of_day = utc - day * 86400.0;
  // 1975-01-01, 1831 days before the GPS epoch, is day 1; t counts from 1899-12-31 12h.
  const double t = (27392.500528 + 1.000000035 * (day + 1832.0)) / 36525.0;
  const double h = reduced_angle(279.69668 + t * (36000.768930485 + t * 3.03e-4));
  const double s = reduced_angle(270.434358 + t * (481267.88314137 + t * (-0.001133 + t * 1.9e-6)));
  const double p = reduced_angle(334.329653 + t * (4069.0340329575 + t * (-0.010325 - t * 1.2e-5)));

  Eigen::Vector3d up_west_south = Eigen::Vector3d::Zero();
  for (int i = 0; i < OceanLoading::kConstituents; ++i) {
    const Wave& wave = kWaves[static_cast<std::size_t>(i)];
    const double angle =
        wave.frequency * second_of_day + wave.h * h + wave.s * s + wave.p * p + wave.turns * kTurn;
    for (int row = 0; row < 3; ++row) {
      up_west_south[row] += loading.amplitude_m(row, i) * std::cos(angle - loading.phase(row, i));
    }
  }
  const Eigen::Vector3d d_n(-up_west_south[2], -up_west_south[1], -up_west_south[0]);
  return rotation_ecef_to_ned(to_geodetic(p_e)).transpose() * d_n;
}

Eigen::Vector3d pole_tide(const Eigen::Vector3d& p_e, GpsTime time, const PolarMotion& pole) {
  if (!(p_e.norm() > kLowestRadius)) return Eigen::Vector3d::Zero();
  constexpr double kArcsecond = kDegree / 3600.0;
  const double years = (seconds_between(time, GpsTime{}) / 86400.0 - 7300.5) / 365.25;  // from 2000
  const double m1 = pole.xp / kArcsecond - (0.0550 + 0.001677 * years);
  const double m2 = -(pole.yp / kArcsecond - (0.3205 + 0.003460 * years));
  const Place at(p_e);
  const double along = m1 * at.cos_longitude + m2 * at.sin_longitude;
  const double across = m1 * at.sin_longitude - m2 * at.cos_longitude;
  // The Conventions count colatitude southwards, so their cos 2 theta is minus cos 2 latitude.
  return 1e-3 * at.ecef(-33.0 * at.sin2() * along, -9.0 * at.cos2() * along,
                        9.0 * at.sin_latitude * across);
}

}  // namespace leonav
