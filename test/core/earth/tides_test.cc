#include "core/earth/tides.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "core/earth/ellipsoid.h"
#include "support/catch.h"

namespace leonav {
namespace {

using Eigen::Vector3d;

GpsTime from_utc(const CalendarTime& calendar) { return gps_from_utc(from_calendar(calendar)); }

}  // namespace

// The test cases in the comments of DEHANTTIDEINEL (IERS Conventions 2010, chapter 7); their Sun
// and Moon are inputs. Step-2 terms below 0.05 mm are left out here: 0.04 mm in these cases.
TEST_CASE("The solid tide meets the Conventions' published values", "[tides]") {
  struct Row {
    CalendarTime utc;
    Vector3d station, sun, moon, displacement;
  };
  for (const Row& row :
       {Row{{2009, 4, 13},
            {4075578.385, 931852.890, 4801570.154},
            {137859926952.015, 54228127881.4350, 23509422341.6960},
            {-179996231.920342, -312468450.131567, -169288918.592160},
            {0.07700420357108125891, 0.06304056321824967613, 0.05516568152597246810}},
        Row{{2012, 7, 13},
            {1112189.660, -4842955.026, 3985352.284},
            {-54537460436.2357, 130244288385.279, 56463429031.5996},
            {300396716.912, 243238281.451, 120548075.939},
            {-0.02036831479592075833, 0.05658254776225972449, -0.07597679676871742227}},
        Row{{2015, 7, 15},
            {1112200.5696, -4842957.8511, 3985345.9122},
            {100210282451.6279, 103055630398.3160, 56855096480.4475},
            {369817604.4348, 1897917.5258, 120804980.8284},
            {0.00509570869172363845, 0.0828663025983528700, -0.0636634925404189617}}}) {
    INFO(row.utc.year);
    const Vector3d d = solid_earth_tide(row.station, from_utc(row.utc), {row.sun, row.moon});
    CHECK((d - row.displacement).cwiseAbs().maxCoeff() < 5e-5);
  }
}

// RTKLIB 2.4.3 (PyPI pyrtklib) tidedisp, options 1 (solid) and 2 (ocean), with its own Sun and Moon
// and without most of the small parts; coefficients of the ocean: Onsala, in the BLQ format's
// description.
TEST_CASE("Solid tide and ocean loading agree with RTKLIB", "[tides]") {
  OceanLoading loading;
  loading.amplitude_m << .00352, .00123, .00080, .00032, .00187, .00112, .00063, .00003, .00082,
      .00044, .00037, .00144, .00035, .00035, .00008, .00053, .00049, .00018, .00009, .00012,
      .00005, .00006, .00086, .00023, .00023, .00006, .00029, .00028, .00010, .00007, .00004,
      .00002, .00001;
  loading.phase << -64.7, -52.0, -96.2, -55.2, -58.8, -151.4, -65.6, -138.1, 8.4, 5.2, 2.1, 85.5,
      114.5, 56.5, 113.6, 99.4, 19.1, 94.1, -10.4, -167.4, -170.0, -177.7, 109.5, 147.0, 92.7,
      148.8, 50.5, -55.1, 36.4, -170.4, -15.0, 2.3, 5.2;
  loading.phase *= kDegree;
  struct Row {
    Vector3d station;
    CalendarTime utc;
    Vector3d solid, ocean;
  };
  const Vector3d denmark(3582104.766, 532590.177, 5232755.098);
  const Vector3d america(1112189.660, -4842955.026, 3985352.284);
  const Vector3d south(-2400000.0, -4700000.0, -3600000.0);
  const Vector3d equator(6378137.0, 0.0, 0.0);
  const CalendarTime spring{2009, 4, 13, 0, 0, 0.0}, summer{2020, 6, 25, 3, 15, 0.0},
      autumn{2026, 11, 21, 17, 30, 30.0};
  for (const Row& row :
       {Row{denmark, spring, {-0.04510, -0.00566, -0.10541}, {0.0004832, 0.0015603, 0.0030515}},
        Row{denmark, summer, {-0.05180, -0.00883, -0.12112}, {0.0002831, 0.0001673, 0.0016837}},
        Row{denmark, autumn, {-0.01115, 0.05083, -0.04533}, {0.0006160, 0.0014482, 0.0023691}},
        Row{america, spring, {-0.04525, 0.03813, -0.03386}, {0.0017816, -0.0011800, 0.0027227}},
        Row{america, summer, {-0.02151, 0.09387, -0.08973}, {0.0002936, -0.0007251, 0.0015267}},
        Row{america, autumn, {-0.03618, 0.02137, -0.07396}, {0.0016355, -0.0011267, 0.0020359}},
        Row{equator, spring, {0.14286, 0.03314, -0.03106}, {0.0029117, 0.0014723, 0.0011549}},
        Row{equator, summer, {0.20402, -0.01103, -0.03815}, {0.0015578, 0.0001239, 0.0007077}},
        Row{equator, autumn, {-0.05340, 0.04236, 0.01068}, {0.0024160, 0.0013418, 0.0006721}},
        Row{south, spring, {-0.00530, 0.04201, 0.06543}, {-0.0000786, -0.0033914, -0.0006868}},
        Row{south, summer, {0.04069, 0.08236, 0.07337}, {-0.0006563, -0.0015577, -0.0002933}},
        Row{south, autumn, {-0.09468, -0.19512, -0.09939}, {0.0001151, -0.0027251, -0.0008063}}}) {
    const GpsTime time = from_utc(row.utc);
    INFO(row.station.x() << " " << row.utc.year);
    const Vector3d solid = solid_earth_tide(row.station, time, sun_moon_positions(time));
    const Vector3d ocean = ocean_loading_displacement(row.station, time, loading);
    CHECK((solid - row.solid).cwiseAbs().maxCoeff() < 3e-3);
    // RTKLIB's vertical is geocentric: 0.2 degrees beside ours, but for the equator.
    const double margin = row.station.z() == 0.0 ? 1e-7 : 0.0034 * row.ocean.norm();
    CHECK((ocean - row.ocean).cwiseAbs().maxCoeff() < margin);
  }
}

// The Conventions' radial and horizontal numbers are Love numbers times the centrifugal potential
// of the pole's offset (eq. 7.24): the horizontal part here from the potential's numerical slope.
TEST_CASE("The pole tide is the slope of the potential of the pole's offset", "[tides]") {
  const GpsTime time = from_calendar({2020, 1, 1});
  const double years = 20.0;
  const double m1 = 0.4, m2 = -0.25;  // arcseconds
  const double arcsecond = kDegree / 3600.0;
  const PolarMotion pole{(m1 + 0.0550 + 0.001677 * years) * arcsecond,
                         (-m2 + 0.3205 + 0.003460 * years) * arcsecond};
  const auto potential = [&](const Vector3d& p) {  // -omega^2 (x z m1 + y z m2)
    return -kEarthRotationRate * kEarthRotationRate * p.z() * (p.x() * m1 + p.y() * m2) * arcsecond;
  };
  for (const double latitude : {-80.0, -33.0, 5.0, 52.0, 88.0}) {
    for (const double longitude : {-150.0, -20.0, 70.0}) {
      const Vector3d up = Vector3d(std::cos(latitude * kDegree) * std::cos(longitude * kDegree),
                                   std::cos(latitude * kDegree) * std::sin(longitude * kDegree),
                                   std::sin(latitude * kDegree));
      const Vector3d p = 6.371e6 * up;
      Vector3d gradient;
      for (int i = 0; i < 3; ++i) {
        const Vector3d step = 100.0 * Vector3d::Unit(i);
        gradient[i] = (potential(p + step) - potential(p - step)) / 200.0;
      }
      const Vector3d slope = gradient - gradient.dot(up) * up;
      const double g = 9.81, h = 0.6207, l = 0.0836;
      const Vector3d expected = h * potential(p) / g * up + l * p.norm() / g * slope;
      const Vector3d d = pole_tide(p, time, pole);
      INFO(latitude << " " << longitude);
      // The Conventions round 33.2 and 9 mm, and their gravity is a mean one.
      CHECK((d - expected).norm() < 0.02 * expected.norm() + 1e-5);
    }
  }
}

TEST_CASE("Tides of no place and of no body are zero or finite", "[tides]") {
  const GpsTime time = from_calendar({2020, 1, 1});
  const SunMoon bodies = sun_moon_positions(time);
  CHECK(solid_earth_tide(Vector3d::Zero(), time, bodies).norm() == 0.0);
  CHECK(pole_tide(Vector3d::Zero(), time, {1e-6, 1e-6}).norm() == 0.0);
  const Vector3d pole(0.0, 0.0, 6356752.3);
  CHECK(solid_earth_tide(pole, time, bodies).norm() < 0.5);
  CHECK(solid_earth_tide(pole, time, SunMoon{}).norm() < 0.02);
}

}  // namespace leonav
