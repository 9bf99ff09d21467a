#include "core/gnss/propagation/phase_wind_up.h"

#include <Eigen/Geometry>
#include <cmath>
#include <complex>
#include <iostream>
#include <limits>
#include <numbers>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/gnss/orbits/satellite_attitude.h"
#include "core/gnss/orbits/yaw_oracle.h"
#include "support/catch.h"

namespace leonav {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d standing(const Vector3d& p_e) {
  return rotation_ecef_to_ned(to_geodetic(p_e)).transpose();
}

// What crossed dipoles do, as complex amplitudes (time goes as exp(j w t)). Dipoles a, b with b fed
// a quarter behind make the field a - j b across the path k; its right-handed part is the amplitude
// of u - j v, with u, v, k right-handed. Used to receive, the same pair gives the scalar product of
// a - j b with the field (reciprocity), a, b and its boresight right-handed: forward, left, up. A
// phase that arrives ahead makes the measured range shorter. No formula in common with Wu's.
double crossed_dipoles(const Vector3d& p_sat, const Matrix3d& C_es, const Vector3d& p_a,
                       const Matrix3d& C_er) {
  using Complex = std::complex<double>;
  const Complex j(0.0, 1.0);
  const Vector3d k = (p_a - p_sat).normalized();
  const Vector3d u = k.unitOrthogonal(), v = k.cross(u);
  const Vector3d a = C_es.col(0), b = C_es.col(1);
  const Complex sent = (a.dot(u) - j * b.dot(u)) + j * (a.dot(v) - j * b.dot(v));
  const Vector3d forward = C_er.col(0), left = -C_er.col(1);
  const Complex taken = (forward.dot(u) - j * left.dot(u)) - j * (forward.dot(v) - j * left.dot(v));
  return -std::arg(sent * taken) / (2.0 * std::numbers::pi);
}

double fraction(double cycles) { return cycles - std::round(cycles); }

}  // namespace

TEST_CASE("Wind-up agrees with RTKLIB", "[wind_up]") {
  for (const test::YawRow& row : test::kYawOracle) {
    Matrix3d C_es;
    C_es << row.x, row.y, row.x.cross(row.y);
    const double cycles =
        phase_wind_up_cycles(row.p_sat_e, C_es, row.p_a_e, standing(row.p_a_e), 0.0);
    CHECK(cycles == Approx(row.wind_up).margin(1e-8));
    CHECK(phase_wind_up_cycles(row.p_sat_e, C_es, row.p_a_e, standing(row.p_a_e), 7.3) ==
          Approx(row.wind_up + std::round(7.3 - row.wind_up)).margin(1e-8));
  }
}

TEST_CASE("Wind-up is the phase between crossed dipoles", "[wind_up]") {
  for (const test::YawRow& row : test::kYawOracle) {
    const Matrix3d C_es =
        satellite_axes(row.p_sat_e, row.v_sat_e, row.p_sun_e, AttitudeLaw::kYawSteering);
    for (const EulerAngles& angles :
         {EulerAngles{0, 0, 0}, EulerAngles{0.2, -0.1, 2.0}, EulerAngles{-0.5, 0.3, -1.1}}) {
      const Matrix3d C_eb = standing(row.p_a_e) * rotation_from_euler(angles);
      const double cycles = phase_wind_up_cycles(row.p_sat_e, C_es, row.p_a_e, C_eb, 0.0);
      CHECK(fraction(cycles - crossed_dipoles(row.p_sat_e, C_es, row.p_a_e, C_eb)) ==
            Approx(0.0).margin(1e-12));
    }
  }
}

TEST_CASE("An antenna turned about its axis winds once per turn, both ways", "[wind_up]") {
  const test::YawRow& row = test::kYawOracle[0];
  const Vector3d overhead = row.p_a_e.normalized() * 2.6e7;
  const Matrix3d C_es =
      satellite_axes(overhead, row.v_sat_e, row.p_sun_e, AttitudeLaw::kYawSteering);
  const auto at = [&](double yaw, double previous) {
    const Matrix3d C_er = standing(row.p_a_e) * rotation_from_euler({0, 0, yaw});
    return phase_wind_up_cycles(overhead, C_es, row.p_a_e, C_er, previous);
  };
  const double start = at(0.0, 0.0);
  double cycles = start;
  for (int step = 1; step <= 50; ++step) cycles = at(step * 0.2 * std::numbers::pi, cycles);
  CHECK(std::abs(cycles - start) == Approx(5.0).margin(1e-9));
  for (int step = 49; step >= 0; --step) cycles = at(step * 0.2 * std::numbers::pi, cycles);
  CHECK(cycles == Approx(start).margin(1e-12));
}

TEST_CASE("A LEO satellite's pass winds without a jump at one epoch a second", "[wind_up]") {
  const double radius = 6.9e6, rate = 7600.0 / radius;
  double fastest = 0.0;
  for (const double off_track : {0.0, 1e-4, 0.02, 0.2}) {  // rad beside the zenith's path
    for (const double beside : {0.0, 0.3, 0.7}) {
      const Vector3d p_a = 6378137.0 * Vector3d(std::cos(beside), -std::sin(beside), 0.0);
      const Matrix3d C_er = standing(p_a) * rotation_from_euler({0.05, -0.1, 0.8});
      double previous = std::numeric_limits<double>::quiet_NaN();
      for (double t = -400.0; t <= 400.0; t += 1.0) {
        const double angle = rate * t;
        const Vector3d p(radius * std::cos(angle) * std::cos(off_track),
                         radius * std::cos(angle) * std::sin(off_track), radius * std::sin(angle));
        const Vector3d v = rate * radius *
                           Vector3d(-std::sin(angle) * std::cos(off_track),
                                    -std::sin(angle) * std::sin(off_track), std::cos(angle));
        const Matrix3d C_es =
            satellite_axes(p, v, Vector3d(1.5e11, 0, 0), AttitudeLaw::kOrbitNormal);
        const double now =
            phase_wind_up_cycles(p, C_es, p_a, C_er, std::isnan(previous) ? 0.0 : previous);
        if (!std::isnan(previous)) fastest = std::max(fastest, std::abs(now - previous));
        previous = now;
      }
    }
  }
  std::cout << "wind-up of LEO passes, fastest: " << fastest << " cycles/s\n";
  CHECK(fastest < 2e-4);
}

TEST_CASE("Wind-up keeps its last value where there is nothing to tell", "[wind_up]") {
  const Vector3d p(6378137.0, 0.0, 0.0);
  const Matrix3d I = Matrix3d::Identity();
  CHECK(phase_wind_up_cycles(p, I, p, I, 2.5) == 2.5);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(phase_wind_up_cycles(Vector3d(nan, 0, 0), I, p, I, 2.5) == 2.5);
  CHECK(phase_wind_up_cycles(2.0 * p, nan * I, p, I, 2.5) == 2.5);
}

}  // namespace leonav
