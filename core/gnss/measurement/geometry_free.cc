#include "core/gnss/measurement/geometry_free.h"

#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

constexpr double kScaleMemory = 20.0;  // epochs
constexpr double kMinScale = 0.7, kMaxScale = 3.0;
constexpr int kMinUpdates = 3;
constexpr double kMaxSquare = 9.0;  // one innovation moves the scale by no more than a 3 sigma one

Eigen::Matrix2d predicted(const Eigen::Matrix2d& covariance, double t, double walk) {
  Eigen::Matrix2d transition;
  transition << 1.0, t, 0.0, 1.0;
  const double q = walk * walk;
  Eigen::Matrix2d noise;
  noise << q * t * t * t / 3.0, q * t * t / 2.0, q * t * t / 2.0, q * t;
  return transition * covariance * transition.transpose() + noise;
}

}  // namespace

void GeometryFreeTrend::start(double value_m, double interval_s, const GeometryFreeNoise& noise,
                              bool keep_rate) {
  const bool keep = keep_rate && updates_ >= kMinUpdates;
  if (keep_rate) learn_scale(innovation(value_m, interval_s, noise));
  const double largest = noise.rate_m_s * noise.rate_m_s;
  const double grown = covariance_(1, 1) + noise.rate_walk_m_s * noise.rate_walk_m_s * interval_s;
  if (!keep) rate_m_s_ = 0.0;
  if (!keep_rate) scale_squared_ = 1.0;
  value_m_ = value_m;
  covariance_ =
      Eigen::Vector2d(noise.value_m * noise.value_m, keep ? std::min(grown, largest) : largest)
          .asDiagonal();
  updates_ = 0;
}

GeometryFreeTrend::Innovation GeometryFreeTrend::innovation(double value_m, double interval_s,
                                                            const GeometryFreeNoise& noise) const {
  const Eigen::Matrix2d covariance = predicted(covariance_, interval_s, noise.rate_walk_m_s);
  const double white = noise.value_m * noise.value_m * scale_squared_;
  return {value_m - value_m_ - rate_m_s_ * interval_s, std::sqrt(covariance(0, 0) + white)};
}

void GeometryFreeTrend::update(double value_m, double interval_s, const GeometryFreeNoise& noise) {
  const Innovation seen = innovation(value_m, interval_s, noise);
  skip(interval_s, noise);
  const double variance = seen.sigma_m * seen.sigma_m;
  const Eigen::Vector2d gain = covariance_.col(0) / variance;
  value_m_ += gain(0) * seen.value_m;
  rate_m_s_ += gain(1) * seen.value_m;
  covariance_ -= gain * gain.transpose() * variance;
  learn_scale(seen);
  updates_ = std::min(updates_ + 1, kMinUpdates);
}

// The model's share of the innovation is fixed; the white part follows the innovations.
void GeometryFreeTrend::learn_scale(const Innovation& seen) {
  const double square =
      std::min(seen.value_m * seen.value_m / (seen.sigma_m * seen.sigma_m), kMaxSquare);
  scale_squared_ = std::clamp(scale_squared_ * (1.0 + (square - 1.0) / kScaleMemory),
                              kMinScale * kMinScale, kMaxScale * kMaxScale);
}

void GeometryFreeTrend::skip(double interval_s, const GeometryFreeNoise& noise) {
  covariance_ = predicted(covariance_, interval_s, noise.rate_walk_m_s);
  value_m_ += rate_m_s_ * interval_s;
}

}  // namespace leonav
