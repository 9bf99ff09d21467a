#include "ideal_imu.h"

#include <array>
#include <cmath>

#include "core/earth/gravity.h"
#include "core/earth/rotation.h"

namespace leonav {
namespace {

const Eigen::Vector3d kOmegaIe(0.0, 0.0, kEarthRotationRate);

// Attitude against an inertial frame that was e at `reference_s`.
Eigen::Quaterniond inertial_attitude(const SmoothTrack& track, double t, double reference_s) {
  return quaternion_from_rotation_vector((t - reference_s) * kOmegaIe) * track.attitude(t);
}

Eigen::Vector3d specific_force_b(const SmoothTrack& track, double t) {
  const TrackInstant now = track.at(t);
  const Eigen::Vector3d f_e = now.a_e + 2.0 * kOmegaIe.cross(now.v_e) - gravity_e(now.p_e);
  return track.attitude(t).conjugate() * f_e;
}

}  // namespace

ImuSample ideal_sample(const SmoothTrack& track, GpsTime start, std::int64_t interval_ns) {
  ImuSample sample;
  sample.time = start.plus_nanoseconds(interval_ns);
  sample.interval_ns = interval_ns;
  const double t = seconds_between(start, track.start());
  const double dt = sample.interval_s();

  constexpr int kSubSteps = 4;
  Eigen::Quaterniond before = inertial_attitude(track, t, t);
  for (int i = 1; i <= kSubSteps; ++i) {
    const Eigen::Quaterniond after = inertial_attitude(track, t + dt * i / kSubSteps, t);
    sample.delta_theta_b += rotation_vector_from_quaternion(before.conjugate() * after);
    before = after;
  }

  const double half_node = 0.5 * std::sqrt(0.6);
  const std::array<double, 3> node{0.5 - half_node, 0.5, 0.5 + half_node};
  constexpr std::array<double, 3> kWeight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  for (std::size_t i = 0; i < node.size(); ++i) {
    sample.delta_velocity_b += kWeight[i] * dt * specific_force_b(track, t + dt * node[i]);
  }
  return sample;
}

}  // namespace leonav
