#include "core/earth/ellipsoid.h"
#include "core/base/angle.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>

#include "support/catch.h"

using namespace leonav;

namespace {

struct Pair {
  double latitude_deg, longitude_deg, height_m;
  Eigen::Vector3d p_e;
};
// CartConvert 2.1.2 of GeographicLib, 9 decimals.
const Pair kPublished[] = {
    {27.99, 86.93, 8820, {302271.432713799, 5635928.367498535, 2979666.134902528}},
    {-33.3, -70.5, -4000, {1780171.044154777, -5027047.950162107, -3479619.344388059}},
    {0, 180, 0, {-6378137.000000000, 0.000000000, 0.000000000}},
    {89.999999, 45, 100, {0.078980804, 0.078980804, 6356852.314245178}},
    {-90, 0, 0, {0.000000000, 0.000000000, -6356752.314245179}},
    {10, -20, 35786000, {39019987.217256263, -14202113.888528982, 7314422.233724130}},
    {52.2, -179.99, 1e6, {-4530307.300891531, -790.687793305, 5806628.561719956}},
    {33.3, 44.4, -3000000, {2021142.059941457, 1979248.536189624, 1834746.981665657}},
    {70, 10, -5000000, {470567.667872429, 82973.776094969, 1272576.903189023}},
    {0.00115578545996, 53.13010235415598, -1378136.998991387, {3e6, 4e6, 100}},
    {89.97997805439833, 63.43494882292201, -751.923549458, {1000, 2000, 6356000}},
    {79.54875590682715, 0, -5847612.444446909, {1e5, 0, 5e5}},
    {25.89767851520829, 165.96375653207352, 39451690.764577366, {-4e7, 1e7, 2e7}},
    {-0.00012529081112, 53.13010235415598, -5878136.999998907, {300000, 400000, -1}},
};
}  // namespace

TEST_CASE("Geodetic coordinates agree with GeographicLib", "[earth]") {
  double worst_forward = 0.0, worst_back = 0.0;
  for (const Pair& pair : kPublished) {
    const Geodetic geodetic{pair.latitude_deg * kDegree, pair.longitude_deg * kDegree,
                            pair.height_m};
    const Eigen::Vector3d p_e = to_ecef(geodetic);
    worst_forward = std::max(worst_forward, (p_e - pair.p_e).norm() / pair.p_e.norm());
    const Geodetic back = to_geodetic(pair.p_e);
    const double radius = pair.p_e.norm();
    const double north = std::abs(back.latitude - geodetic.latitude) * radius;
    const double east =
        std::abs(back.longitude - geodetic.longitude) * std::hypot(pair.p_e.x(), pair.p_e.y());
    const double up = std::abs(back.height - geodetic.height);
    INFO(pair.latitude_deg << " " << pair.longitude_deg << " " << pair.height_m << ": " << north
                           << " " << east << " " << up);
    worst_back = std::max({worst_back, north / radius, east / radius, up / radius});
    CHECK(std::max({north, east, up}) < 2e-8 * std::max(1.0, radius / 6.4e6));
  }
  std::cout << "geodetic against GeographicLib, relative: forward " << worst_forward << ", back "
            << worst_back << "\n";
  CHECK(worst_forward < 2e-15);  // the published numbers have 9 decimals
}

TEST_CASE("Geodetic and back is exact from the core to beyond geostationary", "[earth]") {
  double worst = 0.0;
  for (double latitude = -90.0; latitude <= 90.0; latitude += 0.9) {
    for (const double height : {-3.0e6, -1.0e5, 0.0, 9.0e3, 1.2e6, 2.0e7, 5.0e7}) {
      const Geodetic geodetic{latitude * kDegree, 2.0, height};
      const Eigen::Vector3d p_e = to_ecef(geodetic);
      const Eigen::Vector3d again = to_ecef(to_geodetic(p_e));
      worst = std::max(worst, (again - p_e).norm() / p_e.norm());
    }
  }
  std::cout << "geodetic there and back, relative: " << worst << "\n";
  CHECK(worst < 1e-15);
}

TEST_CASE("Geodetic coordinates of awkward points", "[earth]") {
  const Geodetic centre = to_geodetic(Eigen::Vector3d::Zero());
  CHECK(centre.latitude == 0.0);
  CHECK(centre.longitude == 0.0);
  CHECK(centre.height == -kEarthSemiMajorAxis);
  const Geodetic pole = to_geodetic({0.0, 0.0, -6'356'752.3142451793 - 10.0});
  CHECK(pole.latitude == Approx(-90.0 * kDegree).margin(1e-15));
  CHECK(pole.height == Approx(10.0).margin(1e-9));
  CHECK(to_geodetic({-7e6, 0.0, 0.0}).longitude == std::numbers::pi);
  // Inside the evolute and on the axis near the centre: any answer will do if it is finite.
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(1.0, 0.0, 0.0), Eigen::Vector3d(0.0, 0.0, 1.0),
        Eigen::Vector3d(100.0, 5.0, -3.0), Eigen::Vector3d(1e-300, 0.0, 0.0)}) {
    const Geodetic g = to_geodetic(p);
    CHECK(std::isfinite(g.latitude + g.longitude + g.height));
  }
}

TEST_CASE("North, east and down follow the coordinates' derivatives", "[earth]") {
  const Geodetic g{0.7, -2.1, 1234.0};
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(g);
  const double h = 1e-5;
  const auto move = [&](double north, double east, double down) {
    return to_ecef({g.latitude + north, g.longitude + east, g.height - down});
  };
  const Eigen::Vector3d north = (move(h, 0, 0) - move(-h, 0, 0)) / (2 * h);
  const Eigen::Vector3d east = (move(0, h, 0) - move(0, -h, 0)) / (2 * h);
  const Eigen::Vector3d down = move(0, 0, 1) - move(0, 0, 0);
  CHECK(north.norm() == Approx(meridian_radius(g.latitude) + g.height).epsilon(1e-9));
  CHECK(
      east.norm() ==
      Approx((prime_vertical_radius(g.latitude) + g.height) * std::cos(g.latitude)).epsilon(1e-9));
  CHECK((C_ne * north.normalized() - Eigen::Vector3d::UnitX()).norm() < 1e-8);
  CHECK((C_ne * east.normalized() - Eigen::Vector3d::UnitY()).norm() < 1e-8);
  CHECK((C_ne * down - Eigen::Vector3d::UnitZ()).norm() < 1e-8);
  CHECK(C_ne.determinant() == Approx(1.0).epsilon(1e-14));
}
