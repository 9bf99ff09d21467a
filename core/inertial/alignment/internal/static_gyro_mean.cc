#include "core/inertial/alignment/internal/static_gyro_mean.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"

namespace leonav {
namespace {

constexpr double kPlausible = 4.0;  // sigmas

}  // namespace

StaticGyroMean::StaticGyroMean(const ImuErrorModel& imu)
    : bias_variance_(square(imu.gyro_bias.sigma)), noise_density2_(square(imu.angle_random_walk)) {}

bool StaticGyroMean::is_plausible(const Eigen::Vector3d& rate_b, double seconds) const {
  const double sigma = std::sqrt(bias_variance_ + noise_density2_ / seconds);
  return rate_b.cwiseAbs().maxCoeff() < kPlausible * sigma + kEarthRotationRate;
}

void StaticGyroMean::add(const Eigen::Vector3d& rate_b, double seconds) {
  ++windows_;
  seconds_ += seconds;
  angle_b_ += rate_b * seconds;
  rate_squared_ += rate_b.cwiseAbs2() * seconds;
}

void StaticGyroMean::add(const StaticGyroMean& other) {
  windows_ += other.windows_;
  seconds_ += other.seconds_;
  angle_b_ += other.angle_b_;
  rate_squared_ += other.rate_squared_;
}

void StaticGyroMean::clear() {
  windows_ = 0;
  seconds_ = 0.0;
  angle_b_.setZero();
  rate_squared_.setZero();
}

// White noise averages out. Scatter of the windows beyond it (by three standard deviations of the
// scatter itself) does not: it may be a slow turn over some of them.
//   m^2 = N^2 / T + max(0, scatter - expected scatter of the noise)
double StaticGyroMean::mean_variance() const {
  const Eigen::Vector3d mean = angle_b_ / seconds_;
  const double freedom = windows_ - 1.0;
  const double scatter = (rate_squared_ / seconds_ - mean.cwiseAbs2()).mean() * windows_ / freedom;
  const double noise = noise_density2_ * windows_ / seconds_;
  const double expected = noise * (1.0 + 3.0 * std::sqrt(2.0 / (3.0 * freedom)));
  return noise_density2_ / seconds_ + std::max(0.0, scatter - expected);
}

double StaticGyroMean::mean_sigma() const { return std::sqrt(bias_variance_ + mean_variance()); }

// Share k of the mean that is attributed to the bias, whose prior is zero with its sigma: k =
// sigma_b^2 / (sigma_b^2 + m^2).
double StaticGyroMean::share() const { return bias_variance_ / (bias_variance_ + mean_variance()); }

Eigen::Vector3d StaticGyroMean::rate_b() const {
  if (!known() || !(bias_variance_ > 0.0)) return Eigen::Vector3d::Zero();
  return share() * angle_b_ / seconds_;
}

double StaticGyroMean::sigma() const {
  if (!known() || !(bias_variance_ > 0.0)) return std::sqrt(bias_variance_);
  return std::sqrt(share() * mean_variance());
}

}  // namespace leonav
