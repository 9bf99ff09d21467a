#include "core/gnss/propagation/shapiro.h"

#include "core/earth/ellipsoid.h"
#include "core/gnss/signals/signal.h"
#include "support/catch.h"

namespace leonav {
namespace {

using Eigen::Vector3d;

// The integral that eq. 11.17 is the closed form of: twice the potential over c^2 along the path.
double integrated(const Vector3d& from, const Vector3d& to) {
  constexpr int kSteps = 20000;  // Simpson
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const Vector3d p = from + (to - from) * (static_cast<double>(i) / kSteps);
    const double weight = i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    sum += weight / p.norm();
  }
  const double step = (to - from).norm() / kSteps;
  return 2.0 * kEarthGravitationalConstant / (kSpeedOfLight * kSpeedOfLight) * sum * step / 3.0;
}

}  // namespace

TEST_CASE("Shapiro's delay is the integral of the potential along the path", "[shapiro]") {
  const Vector3d p_a(3582104.766, 532590.177, 5232755.098);
  for (const Vector3d& p_sat :
       {Vector3d(15.6e6, 7.54e6, 20.14e6), Vector3d(2.0e6, 22.0e6, 14.5e6),
        Vector3d(4.0e6, 0.6e6, 5.6e6), Vector3d(5.5e6, -1.0e6, 4.2e6), Vector3d(4.2e7, 0, 0)}) {
    CHECK(shapiro_delay_m(p_sat, p_a) == Approx(integrated(p_sat, p_a)).epsilon(1e-9));
  }
}

// "Up to 2 cm" (ESA GNSS Data Processing, vol. 1, 5.4.2) and the 18.7 mm between a GPS orbit and
// the horizon that Ashby (2003), Living Rev. Relativity 6, gives the order of.
TEST_CASE("Shapiro's delay has the size the literature gives", "[shapiro]") {
  const Vector3d p_a(6378137.0, 0.0, 0.0);
  CHECK(shapiro_delay_m({6378137.0, 25.8e6, 0.0}, p_a) == Approx(0.0187).margin(4e-4));
  CHECK(shapiro_delay_m({26.56e6, 0.0, 0.0}, p_a) == Approx(0.01266).margin(1e-4));
  CHECK(shapiro_delay_m({6.9e6, 0.0, 0.0}, p_a) < 0.001);
}

TEST_CASE("Shapiro's delay is finite where the formula is not", "[shapiro]") {
  const Vector3d p(7e6, 0, 0);
  CHECK(shapiro_delay_m(p, p) == 0.0);
  CHECK(shapiro_delay_m(p, -p) == 0.0);
  CHECK(shapiro_delay_m(Vector3d::Zero(), Vector3d::Zero()) == 0.0);
}

}  // namespace leonav
