// StandstillDetector decides from IMU and speed whether the vehicle stands.
//
// Over one second, in fifths: no mean rate and no change of mean force above its limit, and the
// mean force of the second as in the seconds before. Units: m/s^2, rad/s, m/s; body axes.
#pragma once
#include <Eigen/Core>
#include <array>

#include "core/inertial/strapdown/imu.h"

namespace leonav {

// Limits of the detector.
struct StandstillConfig {
  double max_force_change_m_s2 = 0.1;  // between the means of fifths of a second, each axis
  // Between the mean of the last second and that of the seconds before, each axis. A gentle start
  // shows only in this mean, which is free of vibration.
  double max_force_drift_m_s2 = 0.025;
  double max_rate_rad_s = 0.005;  // mean of any fifth of a second, bias removed
  // The vehicle may stand only if the filter's speed plus 3.5 of its sigmas is below this. An IMU
  // in steady motion measures the same as one at rest, so only this condition excludes creeping
  // traffic.
  double max_speed_m_s = 0.08;
  // Least value of the filter's sigma, which reflections make too small. The speed must also be
  // below three such sigmas: after a stop the filter's speed shows a gentle start far better than
  // the mean force of a fifth of a second.
  double least_sigma_m_s = 0.008;

  bool operator==(const StandstillConfig&) const = default;
};

// StandstillDetector holds the last second of IMU samples and the mean force before it.
class StandstillDetector {
 public:
  explicit StandstillDetector(const StandstillConfig& config) : config_(config) {}
  void reset() { *this = StandstillDetector(config_); }
  // Adds a sample in order of time; a gap starts anew.
  void add(const ImuSample& sample);

  // Returns whether the IMU measures no motion. `rate_bias_b` is the gyros' output at rest, rad/s.
  bool imu_is_static(const Eigen::Vector3d& rate_bias_b) const;
  // Returns whether, moreover, the speed permits a standstill; `speed` and its `sigma` in m/s.
  bool stands(const Eigen::Vector3d& rate_bias_b, double speed, double sigma) const;
  // Returns the mean rate of the last complete fifth of a second, rad/s.
  Eigen::Vector3d rate_b() const;

 private:
  static constexpr int kParts = 5;
  void update_force_mean(const Eigen::Vector3d& force_b);
  Eigen::Vector3d spread() const;
  bool mean_force_is_unchanged() const;
  struct Part {
    double seconds = 0.0;
    Eigen::Vector3d force_b() const { return velocity_b / seconds; }
    Eigen::Vector3d angle_b = Eigen::Vector3d::Zero(), velocity_b = Eigen::Vector3d::Zero();
  };
  StandstillConfig config_;
  std::array<Part, kParts> parts_;
  Part current_;
  // Mean force of the still parts before these, m/s^2, over a few seconds.
  Eigen::Vector3d before_b_ = Eigen::Vector3d::Zero();
  int before_ = 0;  // number of parts in before_b_
  int next_ = 0, known_ = 0;
  GpsTime last_;
};

}  // namespace leonav
