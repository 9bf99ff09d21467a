// What the gyros show while the vehicle stands: their bias, and the Earth's rate.
#pragma once
#include <Eigen/Core>

#include "core/ins/imu_error_model.h"

namespace leonav {

// Mean rate over whole windows of standing, with its uncertainty. A door that closes, a turntable
// or a slow turn in place looks like a standstill too: a window is let in only if its rate can be a
// bias at all, and what the windows scatter beyond the gyros' noise is not believed to average out.
class StandingRate {
 public:
  explicit StandingRate(const ImuErrorModel& imu);

  // Whether a mean rate (rad/s) over `seconds` can be that of gyros at rest: within four sigmas of
  // bias and noise, and the Earth's rate.
  bool is_plausible(const Eigen::Vector3d& rate_b, double seconds) const;
  void add(const Eigen::Vector3d& rate_b, double seconds);
  void add(const StandingRate& other);
  void clear();

  double seconds() const { return seconds_; }
  // rad/s, as measured, and 1 sigma per axis of it as the Earth's rate alone, the bias included.
  // Only if known().
  Eigen::Vector3d mean_b() const { return angle_b_ / seconds_; }
  double mean_sigma() const;
  // From three windows on there is something to compare.
  bool known() const { return windows_ >= 3; }
  // rad/s, drawn towards no bias by what is known of it beforehand; zero unless known().
  Eigen::Vector3d rate_b() const;
  // rad/s, 1 sigma per axis of rate_b() as the bias; before anything is known that of the model.
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
