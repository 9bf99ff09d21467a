#include "tools/sim/sky/orbit_integrator.h"

#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>

#include "core/earth/ellipsoid.h"

namespace leonav::sim {
namespace {

// Unnormalized zonal coefficients of EGM2008 (tide-free).
constexpr double kJ2 = 1.08262617e-3, kJ3 = -2.53241e-6, kJ4 = -1.61990e-6;

using Vector6 = std::array<double, 6>;

}  // namespace

// The potential of degree n is -(GM/r) Jn (R/r)^n Pn(s), s = z/r; its gradient is taken along p and
// z.
Eigen::Vector3d gravitation_i(const Eigen::Vector3d& p_i) {
  const double r = p_i.norm(), s = p_i.z() / r, q = kGravityRadius / r;
  const double g = kEarthGravitationalConstant / (r * r);
  // Legendre polynomials and their derivatives.
  const double s2 = s * s;
  const double p2 = 0.5 * (3.0 * s2 - 1.0), d2 = 3.0 * s;
  const double p3 = 0.5 * s * (5.0 * s2 - 3.0), d3 = 0.5 * (15.0 * s2 - 3.0);
  const double p4 = 0.125 * ((35.0 * s2 - 30.0) * s2 + 3.0), d4 = 0.5 * s * (35.0 * s2 - 15.0);
  const double q2 = q * q, q3 = q2 * q, q4 = q2 * q2;
  const double radial = -1.0 + kJ2 * q2 * (3.0 * p2 + s * d2) + kJ3 * q3 * (4.0 * p3 + s * d3) +
                        kJ4 * q4 * (5.0 * p4 + s * d4);
  const double axial = -(kJ2 * q2 * d2 + kJ3 * q3 * d3 + kJ4 * q4 * d4);
  return g * (radial * p_i / r + axial * Eigen::Vector3d::UnitZ());
}

std::vector<OrbitState> integrate_orbit(const OrbitState& first, double step_s, std::size_t count,
                                        const Perturbation& more) {
  const auto motion = [&more](const Vector6& x, Vector6& dx, double t) {
    const Eigen::Vector3d p_i(x[0], x[1], x[2]);
    Eigen::Vector3d a = gravitation_i(p_i);
    if (more) a += more(p_i, t);
    dx = {x[3], x[4], x[5], a.x(), a.y(), a.z()};
  };
  boost::numeric::odeint::runge_kutta_fehlberg78<Vector6> stepper;
  const int parts = static_cast<int>(std::ceil(std::abs(step_s) / 30.0));
  const double h = step_s / parts;
  Vector6 x{first.p_i.x(), first.p_i.y(), first.p_i.z(),
            first.v_i.x(), first.v_i.y(), first.v_i.z()};
  std::vector<OrbitState> states{first};
  double t = 0.0;
  while (states.size() < count) {
    for (int i = 0; i < parts; ++i, t += h) stepper.do_step(motion, x, t, h);
    states.push_back({{x[0], x[1], x[2]}, {x[3], x[4], x[5]}});
  }
  return states;
}

OrbitState kepler_state(const KeplerElements& k) {
  double anomaly = k.mean_anomaly;
  for (int i = 0; i < 20; ++i) {
    anomaly -= (anomaly - k.eccentricity * std::sin(anomaly) - k.mean_anomaly) /
               (1.0 - k.eccentricity * std::cos(anomaly));
  }
  const double a = k.semi_major_axis_m, e = k.eccentricity, root = std::sqrt(1.0 - e * e);
  const double rate = std::sqrt(kEarthGravitationalConstant / (a * a * a)) /
                      (1.0 - e * std::cos(anomaly));  // rate of the eccentric anomaly
  const double c = std::cos(anomaly), s = std::sin(anomaly);
  const double x = a * (c - e), y = a * root * s, vx = -a * s * rate, vy = a * root * c * rate;
  const double cw = std::cos(k.perigee), sw = std::sin(k.perigee), cn = std::cos(k.node),
               sn = std::sin(k.node), ci = std::cos(k.inclination), si = std::sin(k.inclination);
  const Eigen::Vector3d P(cn * cw - sn * sw * ci, sn * cw + cn * sw * ci, sw * si);
  const Eigen::Vector3d Q(-cn * sw - sn * cw * ci, -sn * sw + cn * cw * ci, cw * si);
  return {x * P + y * Q, vx * P + vy * Q};
}

}  // namespace leonav::sim
