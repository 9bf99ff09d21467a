// Vibration simulates the shaking of engine and road in a band of frequencies.
#pragma once
#include <Eigen/Core>

#include "tools/sim/motion/gaussian_generator.h"

namespace leonav {

// Strength and band of the vibration.
struct VibrationModel {
  // Root mean square per axis at standstill, and its increase per metre per second.
  double accel_idle = 0.0, accel_per_speed = 0.0;  // m/s^2, 1/s
  double gyro_idle = 0.0, gyro_per_speed = 0.0;    // rad/s, rad/m
  double low_hz = 15.0, high_hz = 45.0;            // half-power limits

  bool active() const { return accel_idle + accel_per_speed + gyro_idle + gyro_per_speed > 0.0; }
};

// White noise passes a second-order band-pass whose gain at zero frequency is zero, so that the
// body is shaken without going anywhere.
class Vibration {
 public:
  // Precondition: the band ends below half the rate.
  Vibration(const VibrationModel& model, double rate_hz, GaussianGenerator random);

  struct Shaking {
    Eigen::Vector3d accel_b, omega_b;  // means over one sample, m/s^2 and rad/s
  };
  Shaking next(double speed_m_s);

 private:
  using Six = Eigen::Matrix<double, 6, 1>;
  double impulse_energy() const;

  VibrationModel model_;
  GaussianGenerator random_;
  double gain_ = 1.0, feedback_1_ = 0.0, feedback_2_ = 0.0;
  Six in_1_ = Six::Zero(), in_2_ = Six::Zero(), out_1_ = Six::Zero(), out_2_ = Six::Zero();
};

}  // namespace leonav
