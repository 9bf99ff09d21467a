#include "core/earth/gravity.h"

#include <cmath>
#include <iostream>

#include "core/earth/ellipsoid.h"
#include "support/catch.h"

using namespace leonav;

namespace {

struct GravityAt {
  Eigen::Vector3d p_e, g_e;
};
// NormalGravity::U of GeographicLib 2.1.2 with the constants of core/earth/ellipsoid.h.
const GravityAt kPublishedGravity[] = {
    {{6378137, 0, 0}, {-9.78032533590389, 0, 0}},
    {{0, 0, 6356752.3142451793}, {0, 0, -9.8321849378634}},
    {{3912348.4649880435, 2258795.4394244654, 4487348.4088659193},
     {-6.00504521294829, -3.46701447019157, -6.93402894038314}},
    {{3918472.1893450012, 2262330.9733303981, 4494419.4766777847},
     {-5.98614437845715, -3.4561020683102, -6.91231918570653}},
    {{-1623552.2934619731, -2812075.0610211138, -5587079.6743170833},
     {2.37915528726289, 4.12081783663545, 8.24302988701774}},
    {{11.000569110710529, 1.9396971373663912, 6357252.3142354311},
     {-1.68970313855887e-05, -2.97940252715703e-06, -9.83064342499195}},
    {{-6222097.0390356155, 108607.10780603705, 1370372.9089473616},
     {9.56449098457682, -0.16694881114114, -2.12070195011194}},
    {{1477363.1528962522, 6399162.8543264903, 3770373.7353836368},
     {-1.34774286519463, -5.83771570532913, -3.46760522478477}},
};

}  // namespace

TEST_CASE("Gravity agrees with GeographicLib's normal gravity", "[earth]") {
  double worst = 0.0;
  for (const GravityAt& point : kPublishedGravity) {
    worst = std::max(worst, (gravity_e(point.p_e) - point.g_e).norm());
  }
  std::cout << "gravity against GeographicLib, worst: " << worst << " m/s^2\n";
  CHECK(worst < 1e-13);
}

// NIMA TR8350.2, table 3.4.
TEST_CASE("Gravity on the ellipsoid has the published values", "[earth]") {
  CHECK(gravity_e({kEarthSemiMajorAxis, 0.0, 0.0}).norm() == Approx(9.7803253359).epsilon(1e-11));
  CHECK(gravity_e({0.0, 0.0, kEarthSemiMajorAxis * (1.0 - kEarthFlattening)}).norm() ==
        Approx(9.8321849378).epsilon(1e-11));
}

// On the ellipsoid normal gravity is the ellipsoid's normal, by definition of the model.
TEST_CASE("Gravity on the ellipsoid is plumb", "[earth]") {
  for (double latitude = -1.5; latitude <= 1.5; latitude += 0.3) {
    const Geodetic g{latitude, 1.0, 0.0};
    const Eigen::Vector3d g_n = rotation_ecef_to_ned(g) * gravity_e(to_ecef(g));
    CHECK(std::hypot(g_n.x(), g_n.y()) < 1e-14);
  }
}

TEST_CASE("Gravity gradient agrees with numerical differentiation within 1 %", "[earth]") {
  double worst = 0.0;
  for (double latitude = -1.57; latitude <= 1.57; latitude += 0.157) {
    for (const double height : {-5e3, 0.0, 1e4, 1e6}) {
      const Eigen::Vector3d p_e = to_ecef({latitude, 0.4, height});
      Eigen::Matrix3d numerical;
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d step = 100.0 * Eigen::Vector3d::Unit(i);
        numerical.col(i) = (gravity_e(p_e + step) - gravity_e(p_e - step)) / 200.0;
      }
      const Eigen::Matrix3d error = gravity_gradient_e(p_e) - numerical;
      worst = std::max(worst, error.norm() / numerical.norm());
    }
  }
  std::cout << "gravity gradient, worst relative error: " << worst << "\n";
  CHECK(worst < 0.01);
}

TEST_CASE("Gravity is finite everywhere", "[earth]") {
  for (const double r : {0.0, 1.0, 9.99999e5, 1.0e6, 1.1e6, 1e9}) {
    for (const Eigen::Vector3d& direction :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.6, 0, -0.8)}) {
      const Eigen::Vector3d p_e = r * direction;
      CHECK(gravity_e(p_e).allFinite());
      CHECK(gravity_gradient_e(p_e).allFinite());
    }
  }
}
