// Whether an IMU feels as if it stood: neither jolts nor turns over a second, and as it did before.
#pragma once
#include <Eigen/Core>
#include <array>

#include "core/ins/imu.h"

namespace leonav {

struct StandstillConfig {
  double max_force_change_m_s2 = 0.1;  // between fifths of a second, each axis
  // Between the last second and the seconds before, each axis: one who sets off gently is felt only
  // by the mean, which knows no shaking.
  double max_force_drift_m_s2 = 0.025;
  double max_rate_rad_s = 0.005;  // of any fifth of a second, the bias taken out
  // Speed, that of the filter and 3.5 of its sigmas, below which the vehicle may be taken to stand:
  // an IMU in steady motion feels as one that stands, so only this tells creeping traffic apart.
  double max_speed_m_s = 0.08;
  // Of the filter's sigma, which reflections make too small. Nor may the speed be above three of
  // it: one that sets off after a stop is known far better than by the mean of a fifth of a second.
  double least_sigma_m_s = 0.008;
};

class StandstillDetector {
 public:
  explicit StandstillDetector(const StandstillConfig& config) : config_(config) {}
  void reset() { *this = StandstillDetector(config_); }
  // In order of time; after a hole everything starts anew.
  void add(const ImuSample& sample);

  // `rate_bias_b`: what the gyros show at rest, rad/s.
  bool feels_still(const Eigen::Vector3d& rate_bias_b) const;
  // And the velocity allows it: `speed`, `sigma` in m/s.
  bool stands(const Eigen::Vector3d& rate_bias_b, double speed, double sigma) const;
  // Mean of the last whole fifth of a second, rad/s.
  Eigen::Vector3d rate_b() const;

 private:
  static constexpr int kParts = 5;
  void remember(const Eigen::Vector3d& force_b);
  Eigen::Vector3d spread() const;
  bool goes_on() const;
  struct Part {
    double seconds = 0.0;
    Eigen::Vector3d force_b() const { return velocity_b / seconds; }
    Eigen::Vector3d angle_b = Eigen::Vector3d::Zero(), velocity_b = Eigen::Vector3d::Zero();
  };
  StandstillConfig config_;
  std::array<Part, kParts> parts_;
  Part current_;
  // Of the still parts before these, m/s^2; a few seconds' memory.
  Eigen::Vector3d before_b_ = Eigen::Vector3d::Zero();
  int before_ = 0;  // parts in it; 0: none
  int next_ = 0, known_ = 0;
  GpsTime last_;
};

}  // namespace leonav
