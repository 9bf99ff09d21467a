// StaticGyroMean averages the gyros over windows of standing, which gives their bias or the Earth's
// rate.
//
//   bias = k mean - omega_ie,  k = sigma_b^2 / (sigma_b^2 + m^2),  sigma = sqrt(k) m
//
// sigma_b is the data sheet's bias sigma, m^2 the variance of the mean (Bayes with a normal prior).
#pragma once
#include <Eigen/Core>

#include "core/inertial/strapdown/imu_error_model.h"

namespace leonav {

// StaticGyroMean holds the mean rate over whole windows of standing, with its uncertainty, rad/s.
//
// A door that closes, a turntable or a slow turn in place can resemble a standstill. A window
// therefore counts only if its rate can be a bias at all, and scatter of the windows beyond the
// gyros' noise is not assumed to average out.
class StaticGyroMean {
 public:
  explicit StaticGyroMean(const ImuErrorModel& imu);

  // Returns whether a mean rate (rad/s) over `seconds` can be measured by gyros at rest: within
  // four sigmas of bias and noise, plus the Earth's rate.
  bool is_plausible(const Eigen::Vector3d& rate_b, double seconds) const;
  // Adds a window of `seconds` with its mean rate (rad/s), or all windows of `other`.
  void add(const Eigen::Vector3d& rate_b, double seconds);
  void add(const StaticGyroMean& other);
  void clear();

  double seconds() const { return seconds_; }
  // Mean rate as measured, rad/s, and its 1 sigma per axis as an estimate of the Earth's rate, the
  // bias included. Precondition: known().
  Eigen::Vector3d mean_b() const { return angle_b_ / seconds_; }
  double mean_sigma() const;
  // Returns whether there are three windows, enough to compare them with each other.
  bool known() const { return windows_ >= 3; }
  // Returns the estimated bias plus the Earth's rate, rad/s, reduced by the factor k of the prior;
  // zero unless known().
  Eigen::Vector3d rate_b() const;
  // Returns the 1 sigma per axis, rad/s, of rate_b() as a bias; before known() that of the model.
  double sigma() const;

 private:
  double mean_variance() const;
  double share() const;

  double bias_variance_, noise_density2_;
  double seconds_ = 0.0;
  int windows_ = 0;
  Eigen::Vector3d angle_b_ = Eigen::Vector3d::Zero();       // sum of rate * seconds
  Eigen::Vector3d rate_squared_ = Eigen::Vector3d::Zero();  // sum of rate^2 * seconds
};

}  // namespace leonav
