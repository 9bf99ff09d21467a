#include "tools/sim/motion/ideal_imu.h"

#include <array>
#include <cmath>

#include "core/earth/gravity.h"

namespace leonav {
namespace {

const Eigen::Vector3d kOmegaIe(0.0, 0.0, kEarthRotationRate);

Eigen::Vector3d specific_force_b(const MotionInstant& now) {
  const Eigen::Vector3d f_e = now.a_e + 2.0 * kOmegaIe.cross(now.v_e) - gravity_e(now.p_e);
  return now.q_eb.conjugate() * f_e;
}

}  // namespace

ImuSample ideal_sample(const SplineMotion& motion, GpsTime start, std::int64_t interval_ns) {
  ImuSample sample;
  sample.time = start.plus_nanoseconds(interval_ns);
  sample.interval_ns = interval_ns;
  const double t = seconds_between(start, motion.start());
  const double dt = sample.interval_s();

  const double half_node = 0.5 * std::sqrt(0.6);
  const std::array<double, 3> node{0.5 - half_node, 0.5, 0.5 + half_node};
  constexpr std::array<double, 3> kWeight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  for (std::size_t i = 0; i < node.size(); ++i) {
    const MotionInstant now = motion.at(t + dt * node[i]);
    sample.delta_theta_b += kWeight[i] * dt * now.omega_ib_b;
    sample.delta_velocity_b += kWeight[i] * dt * specific_force_b(now);
  }
  return sample;
}

}  // namespace leonav
