#include "core/gnss/measurement/look_angles.h"

#include "core/base/angle.h"
#include "core/earth/ellipsoid.h"
#include "support/catch.h"

namespace leonav {

TEST_CASE("Look angles agree with RTKLIB's", "[look_angles]") {
  struct Row {
    Eigen::Vector3d antenna, satellite;
    double azimuth, elevation;
  };
  for (const Row& row : {Row{{3582104.766, 532590.177, 5232755.098},
                             {21913332.2, 15001428.1, -918579.4},
                             2.619306691256,
                             0.268560659219},
                         Row{{3582104.766, 532590.177, 5232755.098},
                             {1.2e7, -1.3e7, 2.1e7},
                             4.960893917540,
                             0.832593984803},
                         Row{{-2700000., -4290000., 3850000.},
                             {-1.9e7, -1.5e7, 1.1e7},
                             4.149951197334,
                             1.092362097048}}) {
    const LookAngles angles = look_angles(row.satellite, row.antenna);
    CHECK(angles.azimuth == Approx(row.azimuth).margin(1e-9));
    CHECK(angles.elevation == Approx(row.elevation).margin(1e-9));
  }
}

TEST_CASE("Zenith, horizon and nadir", "[look_angles]") {
  const Eigen::Vector3d antenna(kEarthSemiMajorAxis, 0.0, 0.0);
  const auto towards = [&](double x, double y, double z) {
    return look_angles(antenna + 1e7 * Eigen::Vector3d(x, y, z), antenna);
  };
  CHECK(towards(1, 0, 0).elevation == Approx(kPi / 2));
  CHECK(towards(-1, 0, 0).elevation == Approx(-kPi / 2));
  CHECK(towards(0, 1, 0).azimuth == Approx(kPi / 2));  // east
  CHECK(towards(0, 0, 1).azimuth == Approx(0.0).margin(1e-12));
  CHECK(towards(0, -1, 0).azimuth == Approx(1.5 * kPi));  // west
  CHECK(towards(0, 0, -1).azimuth == Approx(kPi));
  CHECK(towards(0, -1e-30, 1).azimuth < 2.0 * kPi);
  const LookAngles self = look_angles(antenna, antenna);
  CHECK(self.elevation == 0.0);
  CHECK(self.azimuth == 0.0);
}

}  // namespace leonav
