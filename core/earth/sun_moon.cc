#include "core/earth/sun_moon.h"

#include <array>
#include <cmath>

#include "core/base/angle.h"
#include "core/base/calendar.h"

namespace leonav {
namespace {

constexpr double kArcsecond = kDegree / 3600.0;
constexpr double kAstronomicalUnit = 149'597'870'700.0;  // m, IAU 2012 B2
constexpr double kSecondsPerDay = 86400.0;
constexpr double kTtMinusGps = 51.184;   // s: TT = TAI + 32.184, TAI = GPS + 19
constexpr double kDaysToJ2000 = 7300.5;  // from 1980-01-06 0h to 2000-01-01 12h

// Reducing an angle modulo a turn first keeps its digits when it is multiplied.
double seconds_since_gps_epoch(GpsTime time) { return seconds_between(time, GpsTime{}); }

// Delaunay-like arguments of Meeus 47.1-47.6, rad, and the eccentricity factor of eq. 47.6.
struct Arguments {
  double l, d, m, m_moon, f, e;
};

Arguments arguments_at(double t) {
  return {reduced_angle(218.3164477 + t * (481267.88123421 + t * (-0.0015786 + t / 538841.0))),
          reduced_angle(297.8501921 + t * (445267.1114034 + t * (-0.0018819 + t / 545868.0))),
          reduced_angle(357.5291092 + t * (35999.0502909 - t * 0.0001536)),
          reduced_angle(134.9633964 + t * (477198.8675055 + t * (0.0087414 + t / 69699.0))),
          reduced_angle(93.2720950 + t * (483202.0175233 + t * (-0.0036539 - t / 3526000.0))),
          1.0 - t * (0.002516 + t * 0.0000074)};
}

// Each term has the multiples of D, M, M', F, the sine coefficient of the longitude in 1e-6
// degrees, and the cosine coefficient of the distance in m. They are the terms of Meeus, table
// 47.A, down to 2000 units of 1e-6 degrees.
struct LongitudeTerm {
  int d, m, m_moon, f;
  double longitude, distance;
};
constexpr std::array<LongitudeTerm, 36> kLongitude = {{
    {0, 0, 1, 0, 6288774, -20905355}, {2, 0, -1, 0, 1274027, -3699111},
    {2, 0, 0, 0, 658314, -2955968},   {0, 0, 2, 0, 213618, -569925},
    {0, 1, 0, 0, -185116, 48888},     {0, 0, 0, 2, -114332, -3149},
    {2, 0, -2, 0, 58793, 246158},     {2, -1, -1, 0, 57066, -152138},
    {2, 0, 1, 0, 53322, -170733},     {2, -1, 0, 0, 45758, -204586},
    {0, 1, -1, 0, -40923, -129620},   {1, 0, 0, 0, -34720, 108743},
    {0, 1, 1, 0, -30383, 104755},     {2, 0, 0, -2, 15327, 10321},
    {0, 0, 1, 2, -12528, 0},          {0, 0, 1, -2, 10980, 79661},
    {4, 0, -1, 0, 10675, -34782},     {0, 0, 3, 0, 10034, -23210},
    {4, 0, -2, 0, 8548, -21636},      {2, 1, -1, 0, -7888, 24208},
    {2, 1, 0, 0, -6766, 30824},       {1, 0, -1, 0, -5163, -8379},
    {1, 1, 0, 0, 4987, -16675},       {2, -1, 1, 0, 4036, -12831},
    {2, 0, 2, 0, 3994, -10445},       {4, 0, 0, 0, 3861, -11650},
    {2, 0, -3, 0, 3665, 14403},       {0, 1, -2, 0, -2689, -7003},
    {2, 0, -1, 2, -2602, 0},          {2, -1, -2, 0, 2390, 10056},
    {1, 0, 1, 0, -2348, 6322},        {2, -2, 0, 0, 2236, -9884},
    {0, 1, 2, 0, -2120, 5751},        {0, 2, 0, 0, -2069, 0},
    {2, -2, -1, 0, 2048, -4950},      {2, 0, 1, -2, -1773, 4130},
}};

// Each term has the same multiples and the sine coefficient of the latitude in 1e-6 degrees: Meeus
// table 47.B.
struct LatitudeTerm {
  int d, m, m_moon, f;
  double latitude;
};
constexpr std::array<LatitudeTerm, 22> kLatitude = {{
    {0, 0, 0, 1, 5128122}, {0, 0, 1, 1, 280602},  {0, 0, 1, -1, 277693}, {2, 0, 0, -1, 173237},
    {2, 0, -1, 1, 55413},  {2, 0, -1, -1, 46271}, {2, 0, 0, 1, 32573},   {0, 0, 2, 1, 17198},
    {2, 0, 1, -1, 9266},   {0, 0, 2, -1, 8822},   {2, -1, 0, -1, 8216},  {2, 0, -2, -1, 4324},
    {2, 0, 1, 1, 4200},    {2, 1, 0, -1, -3359},  {2, -1, -1, 1, 2463},  {2, -1, 0, 1, 2211},
    {2, -1, -1, -1, 2065}, {0, 1, -1, -1, -1870}, {4, 0, -1, -1, 1828},  {0, 1, 0, 1, -1794},
    {0, 0, 0, 3, -1749},   {0, 1, -1, 1, -1565},
}};

double eccentricity_factor(int multiple_of_m, double e) {
  if (multiple_of_m == 0) return 1.0;
  return multiple_of_m == 2 || multiple_of_m == -2 ? e * e : e;
}

struct Ecliptic {
  double longitude, latitude, distance;  // rad, rad, m; mean equinox and ecliptic of date
};

Ecliptic moon_at(double t) {
  const Arguments a = arguments_at(t);
  const double a1 = reduced_angle(119.75 + 131.849 * t);    // term of Venus
  const double a2 = reduced_angle(53.09 + 479264.290 * t);  // term of Jupiter
  const double a3 = reduced_angle(313.45 + 481266.484 * t);
  double longitude = 3958.0 * std::sin(a1) + 1962.0 * std::sin(a.l - a.f) + 318.0 * std::sin(a2);
  double latitude = -2235.0 * std::sin(a.l) + 382.0 * std::sin(a3);
  double distance = 385'000'560.0;
  for (const LongitudeTerm& term : kLongitude) {
    const double argument = term.d * a.d + term.m * a.m + term.m_moon * a.m_moon + term.f * a.f;
    const double factor = eccentricity_factor(term.m, a.e);
    longitude += term.longitude * factor * std::sin(argument);
    distance += term.distance * factor * std::cos(argument);
  }
  for (const LatitudeTerm& term : kLatitude) {
    const double argument = term.d * a.d + term.m * a.m + term.m_moon * a.m_moon + term.f * a.f;
    latitude += term.latitude * eccentricity_factor(term.m, a.e) * std::sin(argument);
  }
  return {a.l + longitude * 1e-6 * kDegree, latitude * 1e-6 * kDegree, distance};
}

// The Sun's position follows Meeus 25.2-25.5: Kepler motion with the mean elements of date. The
// Moon's pull on the Earth (6.4", 4671 km) is added, since it is the largest of the remaining
// terms.
Ecliptic sun_at(double t) {
  const double mean_longitude = reduced_angle(280.46646 + t * (36000.76983 + t * 0.0003032));
  const double m = reduced_angle(357.52911 + t * (35999.05029 - t * 0.0001537));
  const double e = 0.016708634 - t * (0.000042037 + t * 0.0000001267);
  const double centre =
      kDegree * ((1.914602 - t * (0.004817 + t * 0.000014)) * std::sin(m) +
                 (0.019993 - t * 0.000101) * std::sin(2.0 * m) + 0.000289 * std::sin(3.0 * m));
  const double d = arguments_at(t).d;
  const double distance =
      kAstronomicalUnit * 1.000001018 * (1.0 - e * e) / (1.0 + e * std::cos(m + centre)) +
      4.671e6 * std::cos(d);
  return {mean_longitude + centre + 6.44 * kArcsecond * std::sin(d), 0.0, distance};
}

Eigen::Vector3d to_earth_fixed(const Ecliptic& place, double nutation, double obliquity,
                               double sidereal) {
  const double longitude = place.longitude + nutation;
  const double x = std::cos(place.latitude) * std::cos(longitude);
  const double y = std::cos(place.latitude) * std::sin(longitude);
  const double z = std::sin(place.latitude);
  const double y_equator = y * std::cos(obliquity) - z * std::sin(obliquity);
  const double z_equator = y * std::sin(obliquity) + z * std::cos(obliquity);
  const double c = std::cos(sidereal);
  const double s = std::sin(sidereal);
  return place.distance * Eigen::Vector3d(x * c + y_equator * s, y_equator * c - x * s, z_equator);
}

}  // namespace

SunMoon sun_moon_positions(GpsTime time) {
  const double seconds = seconds_since_gps_epoch(time);
  const double t = ((seconds + kTtMinusGps) / kSecondsPerDay - kDaysToJ2000) / 36525.0;

  // Nutation (Meeus, chapter 22) is limited to the terms above 0.2".
  const double node = reduced_angle(125.04452 - 1934.136261 * t);
  const double sun2 = 2.0 * reduced_angle(280.4665 + 36000.7698 * t);
  const double moon2 = 2.0 * reduced_angle(218.3165 + 481267.8813 * t);
  const double nutation = kArcsecond * (-17.20 * std::sin(node) - 1.32 * std::sin(sun2) -
                                        0.23 * std::sin(moon2) + 0.21 * std::sin(2.0 * node));
  const double obliquity =
      kDegree * (23.4392911 - 0.0130042 * t) +
      kArcsecond * (9.20 * std::cos(node) + 0.57 * std::cos(sun2) + 0.10 * std::cos(moon2));

  // Sidereal time is Meeus eq. 12.4 with UT1 = UTC; whole turns of a day are removed beforehand.
  const double utc = seconds - leap_seconds(time);
  const double days = utc / kSecondsPerDay - kDaysToJ2000;
  const double tu = days / 36525.0;
  const double turn = std::fmod(utc, kSecondsPerDay) / kSecondsPerDay * 360.0 + 180.0;
  const double sidereal =
      reduced_angle(280.46061837 + turn + 0.98564736629 * days + tu * tu * 0.000387933) +
      nutation * std::cos(obliquity);

  return {to_earth_fixed(sun_at(t), nutation, obliquity, sidereal),
          to_earth_fixed(moon_at(t), nutation, obliquity, sidereal)};
}

}  // namespace leonav
