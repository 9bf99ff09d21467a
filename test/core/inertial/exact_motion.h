// Motions in closed form and the increments a perfect IMU would give on them: rates and specific
// force from truncated Taylor series in extended precision, integrated by Gauss-Legendre. Nothing
// here is shared with the mechanization but the gravity model.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>

#include "core/earth/ellipsoid.h"
#include "core/earth/gravity.h"
#include "core/inertial/strapdown/imu.h"
#include "core/inertial/strapdown/nav_state.h"

namespace leonav::test {

using Real = long double;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Matrix3r = Eigen::Matrix<Real, 3, 3>;

// A motion at one instant, against e: position with two derivatives, C_eb with one.
struct Kinematics {
  Vector3r p, v, a;
  Matrix3r C, C_dot;
};

// The body's rate against i and specific force, both in b.
struct Felt {
  Vector3r omega_ib_b, force_b;
};
inline Felt felt(const Kinematics& k) {
  const Vector3r omega_ie(0, 0, static_cast<Real>(kEarthRotationRate));
  const Matrix3r omega_eb_b = k.C.transpose() * k.C_dot;  // skew
  const Vector3r gravity = gravity_e(k.p.cast<double>()).cast<Real>();
  Felt result;
  result.omega_ib_b =
      Vector3r(omega_eb_b(2, 1), omega_eb_b(0, 2), omega_eb_b(1, 0)) + k.C.transpose() * omega_ie;
  result.force_b = k.C.transpose() * (k.a + 2 * omega_ie.cross(k.v) - gravity);
  return result;
}

// Increments over (t, t + dt] by three-point Gauss-Legendre: error of order dt^7.
template <typename Motion>
ImuSample exact_sample(const Motion& motion, GpsTime start, std::int64_t offset_ns,
                       std::int64_t interval_ns) {
  static const std::array<Real, 3> node{-std::sqrt(0.6L), 0.0L, std::sqrt(0.6L)};
  constexpr std::array<Real, 3> weight{5.0L / 18.0L, 8.0L / 18.0L, 5.0L / 18.0L};
  const Real dt = interval_ns * 1e-9L, t = offset_ns * 1e-9L;
  Vector3r theta = Vector3r::Zero(), velocity = Vector3r::Zero();
  for (std::size_t i = 0; i < node.size(); ++i) {
    const Felt f = felt(motion.at(t + dt * (0.5L + 0.5L * node[i])));
    theta += weight[i] * dt * f.omega_ib_b;
    velocity += weight[i] * dt * f.force_b;
  }
  ImuSample sample;
  sample.time = start.plus_nanoseconds(offset_ns + interval_ns);
  sample.interval_ns = interval_ns;
  sample.delta_theta_b = theta.cast<double>();
  sample.delta_velocity_b = velocity.cast<double>();
  return sample;
}

template <typename Motion>
NavState exact_state(const Motion& motion, GpsTime start, std::int64_t offset_ns) {
  const Kinematics k = motion.at(offset_ns * 1e-9L);
  NavState state;
  state.time = start.plus_nanoseconds(offset_ns);
  state.p_e = k.p.template cast<double>();
  state.v_e = k.v.template cast<double>();
  state.q_eb = Eigen::Quaterniond(Eigen::Matrix3d(k.C.template cast<double>())).normalized();
  return state;
}

// At rest on the rotating Earth, tilted.
struct Static {
  Kinematics fixed;
  Static(const Geodetic& where, const Eigen::Matrix3d& C_nb) {
    fixed.p = to_ecef(where).cast<Real>();
    fixed.v.setZero();
    fixed.a.setZero();
    fixed.C = (rotation_ecef_to_ned(where).transpose() * C_nb).cast<Real>();
    fixed.C_dot.setZero();
  }
  Kinematics at(Real) const { return fixed; }
};

// Clockwise circle in the local level plane of a point, nose along the course.
struct Circle {
  Matrix3r C_en;
  Vector3r centre;
  Real radius, rate;
  Circle(const Geodetic& where, double radius_m, double speed_m_s)
      : C_en(rotation_ecef_to_ned(where).transpose().cast<Real>()),
        centre(to_ecef(where).cast<Real>()),
        radius(radius_m),
        rate(speed_m_s / radius_m) {}
  Kinematics at(Real t) const {
    const Real s = std::sin(rate * t), c = std::cos(rate * t);
    Kinematics k;
    k.p = centre + C_en * Vector3r(radius * s, -radius * c, 0);
    k.v = C_en * Vector3r(radius * rate * c, radius * rate * s, 0);
    k.a = C_en * Vector3r(-radius * rate * rate * s, radius * rate * rate * c, 0);
    Matrix3r C_nb, C_nb_dot;
    C_nb << c, -s, 0, s, c, 0, 0, 0, 1;
    C_nb_dot << -s, -c, 0, c, -s, 0, 0, 0, 0;
    k.C = C_en * C_nb;
    k.C_dot = C_en * (rate * C_nb_dot);
    return k;
  }
};

// Along a meridian and over the pole at constant height; latitude grows evenly and goes on past 90
// degrees, down the other side. Nose ahead, level.
struct OverThePole {
  Real start_latitude, rate, longitude, height;
  Kinematics at(Real t) const {
    const Real latitude = start_latitude + rate * t;
    const Real s = std::sin(latitude), c = std::cos(latitude);
    const Real sl = std::sin(longitude), cl = std::cos(longitude);
    const Real a = kEarthSemiMajorAxis, e2 = kEarthEccentricitySquared;
    // N(latitude) and its two derivatives.
    const Real d = 1 - e2 * s * s, root = std::sqrt(d);
    const Real n = a / root, n1 = a * e2 * s * c / (d * root);
    const Real n2 =
        a * e2 * ((c * c - s * s) / (d * root) + 3 * e2 * s * s * c * c / (d * d * root));
    // In the meridian's plane: distance from the axis and height above the equator.
    const Real r = n + height, r1 = n1, r2 = n2;
    const Real q = n * (1 - e2) + height, q1 = n1 * (1 - e2), q2 = n2 * (1 - e2);
    const Real x = r * c, x1 = r1 * c - r * s, x2 = r2 * c - 2 * r1 * s - r * c;
    const Real z = q * s, z1 = q1 * s + q * c, z2 = q2 * s + 2 * q1 * c - q * s;
    Kinematics k;
    k.p = {x * cl, x * sl, z};
    k.v = rate * Vector3r(x1 * cl, x1 * sl, z1);
    k.a = rate * rate * Vector3r(x2 * cl, x2 * sl, z2);
    const Vector3r ahead(-s * cl, -s * sl, c), right(-sl, cl, 0), down(-c * cl, -c * sl, -s);
    k.C.col(0) = ahead;
    k.C.col(1) = right;
    k.C.col(2) = down;
    k.C_dot.col(0) = rate * down;
    k.C_dot.col(1).setZero();
    k.C_dot.col(2) = -rate * ahead;
    return k;
  }
};

// Shakes about a point: classical coning in attitude (axis turning in the x-y plane, half angle
// `cone`) and a small circle of the same frequency in position, which makes sculling.
struct ConingAndSculling {
  Matrix3r C_en;
  Vector3r centre;
  Real cone, frequency, amplitude;
  ConingAndSculling(const Geodetic& where, double cone_rad, double rate_rad_s, double amplitude_m)
      : C_en(rotation_ecef_to_ned(where).transpose().cast<Real>()),
        centre(to_ecef(where).cast<Real>()),
        cone(cone_rad),
        frequency(rate_rad_s),
        amplitude(amplitude_m) {}
  Kinematics at(Real t) const {
    const Real w = frequency, s = std::sin(w * t), c = std::cos(w * t);
    Kinematics k;
    k.p = centre + C_en * Vector3r(amplitude * s, 0, amplitude * c);
    k.v = C_en * (w * amplitude * Vector3r(c, 0, -s));
    k.a = C_en * (w * w * amplitude * Vector3r(-s, 0, -c));
    // Rodrigues about the axis (c, s, 0).
    const Real sa = std::sin(cone), ca = std::cos(cone), m = 1 - ca;
    Matrix3r C_nb, C_nb_dot;
    C_nb << ca + m * c * c, m * c * s, sa * s,  //
        m * c * s, ca + m * s * s, -sa * c,     //
        -sa * s, sa * c, ca;
    C_nb_dot << -2 * m * c * s, m * (c * c - s * s), sa * c,  //
        m * (c * c - s * s), 2 * m * c * s, sa * s,           //
        -sa * c, -sa * s, 0;
    k.C = C_en * C_nb;
    k.C_dot = C_en * (w * C_nb_dot);
    return k;
  }
};

}  // namespace leonav::test
