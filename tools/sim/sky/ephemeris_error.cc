#include "tools/sim/sky/ephemeris_error.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/earth/ellipsoid.h"
#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {

EphemerisError::EphemerisError(const EphemerisErrors& sigma, SatelliteId satellite, double period_s,
                               std::uint64_t seed, std::string what)
    : sigma_(sigma),
      satellite_(satellite),
      rate_(2.0 * std::numbers::pi / period_s),
      seed_(seed),
      what_(std::move(what)) {}

// Numbers of satellites are below 4096; updates before the start have separate numbers too.
std::uint64_t EphemerisError::stream_of(double t) const {
  const double update = sigma_.update_s > 0.0 ? std::floor(t / sigma_.update_s) : 0.0;
  const auto number = static_cast<std::int64_t>(update);
  return table_index_of(satellite_) + 4096ULL * static_cast<std::uint64_t>(number);
}

Eigen::Vector3d EphemerisError::orbit_m(double t) const {
  GaussianGenerator random = random_stream(seed_, what_ + " orbit", stream_of(t));
  const Eigen::Vector3d cosine = random.draw_three(), sine = random.draw_three();
  return sigma_.orbit_m.cwiseProduct(std::cos(rate_ * t) * cosine + std::sin(rate_ * t) * sine);
}

double EphemerisError::clock_m(double t) const {
  GaussianGenerator random = random_stream(seed_, what_ + " clock", stream_of(t));
  const double constant = random.draw(), cosine = random.draw(), sine = random.draw();
  return sigma_.clock_m * constant +
         sigma_.clock_varying_m * (std::cos(rate_ * t) * cosine + std::sin(rate_ * t) * sine);
}

double period_s(const OrbitState& state) {
  const double a =
      1.0 / (2.0 / state.p_i.norm() - state.v_i.squaredNorm() / kEarthGravitationalConstant);
  return 2.0 * std::numbers::pi * std::sqrt(a * a * a / kEarthGravitationalConstant);
}

Eigen::Vector3d in_inertial(const OrbitState& state, const Eigen::Vector3d& along_cross_radial) {
  const Eigen::Vector3d radial = state.p_i.normalized();
  const Eigen::Vector3d cross = state.p_i.cross(state.v_i).normalized();
  const Eigen::Vector3d along = cross.cross(radial);
  return along_cross_radial.x() * along + along_cross_radial.y() * cross +
         along_cross_radial.z() * radial;
}

}  // namespace leonav::sim
