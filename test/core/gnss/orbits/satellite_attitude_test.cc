#include "core/gnss/orbits/satellite_attitude.h"

#include <Eigen/Geometry>
#include <limits>

#include "core/earth/ellipsoid.h"
#include "support/catch.h"
#include "yaw_oracle.h"

namespace leonav {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void check_rotation(const Matrix3d& C) {
  CHECK((C.transpose() * C - Matrix3d::Identity()).norm() < 1e-14);
  CHECK(C.determinant() == Approx(1.0).margin(1e-14));
}

}  // namespace

// RTKLIB's yaw angle has half a turn more, so that its X and Y point the other way here (its own
// antenna offsets are applied in axes like ours). It sees the Sun from the Earth's centre, here it
// is seen from the satellite: 2e-4 rad apart, more where the satellite stands near the line to the
// Sun.
TEST_CASE("Yaw steering agrees with the yaw angle of RTKLIB", "[attitude]") {
  for (const test::YawRow& row : test::kYawOracle) {
    const Matrix3d C_es =
        satellite_axes(row.p_sat_e, row.v_sat_e, row.p_sun_e, AttitudeLaw::kYawSteering);
    check_rotation(C_es);
    CHECK((C_es.col(0) + row.x).norm() < 4e-4);
    CHECK((C_es.col(1) + row.y).norm() < 4e-4);
    CHECK(C_es.col(0).dot(row.p_sun_e - row.p_sat_e) >= 0.0);
  }
}

TEST_CASE("With the orbit's normal X flies ahead and Y points against the momentum", "[attitude]") {
  const Vector3d p(0.0, 6.9e6, 1.0e5);
  const Vector3d inertial(7500.0, -10.0, 1000.0);
  const Vector3d v_e = inertial - Vector3d(0.0, 0.0, kEarthRotationRate).cross(p);
  const Matrix3d C_es = satellite_axes(p, v_e, Vector3d(1.5e11, 0, 0), AttitudeLaw::kOrbitNormal);
  check_rotation(C_es);
  CHECK((C_es.col(2) + p.normalized()).norm() < 1e-14);
  CHECK(C_es.col(0).dot(inertial) > 0.99 * inertial.norm());
  CHECK((C_es.col(1) + p.cross(inertial).normalized()).norm() < 1e-12);
}

TEST_CASE("Every satellite has its law", "[attitude]") {
  for (const AttitudeLaw leo : {AttitudeLaw::kOrbitNormal, AttitudeLaw::kYawSteering}) {
    CHECK(attitude_law({System::kGps, 5}, leo) == AttitudeLaw::kYawSteering);
    CHECK(attitude_law({System::kGalileo, 5}, leo) == AttitudeLaw::kYawSteering);
    CHECK(attitude_law({System::kBeidou, 6}, leo) == AttitudeLaw::kYawSteering);
    CHECK(attitude_law({System::kBeidou, 3}, leo) == AttitudeLaw::kOrbitNormal);
    CHECK(attitude_law({System::kLeo, 3}, leo) == leo);
  }
}

TEST_CASE("The axes are a rotation whatever stands in line with what", "[attitude]") {
  const Vector3d p(2.6e7, 0.0, 0.0), v(0.0, 3000.0, 1000.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vector3d& sun : {Vector3d(1.5e11, 0, 0), Vector3d(-1.5e11, 0, 0), Vector3d(p),
                              Vector3d(1.5e11, 1.0, 0), Vector3d(nan, 0, 0)}) {
    const Matrix3d C_es = satellite_axes(p, v, sun, AttitudeLaw::kYawSteering);
    check_rotation(C_es);
    CHECK(C_es.col(2).x() == Approx(-1.0));
    CHECK(C_es == satellite_axes(p, v, sun, AttitudeLaw::kOrbitNormal));
  }
  check_rotation(satellite_axes(p, Vector3d::Zero(), p, AttitudeLaw::kYawSteering));
  const Vector3d pole(0.0, 0.0, 2.6e7);
  check_rotation(satellite_axes(pole, Vector3d(0, 0, 100), pole, AttitudeLaw::kYawSteering));
  check_rotation(satellite_axes(Vector3d::Zero(), v, p, AttitudeLaw::kYawSteering));
}

}  // namespace leonav
