// InertialSensor adds to ideal increments all errors of a real IMU.
//
// Besides the noise and biases of the data sheet these are the effects of mounting, temperature,
// vibration and quantization. The estimator's model does not contain them.
#pragma once
#include <Eigen/Core>

#include "tools/sim/motion/sensor_errors.h"
#include "tools/sim/motion/vibration.h"

namespace leonav {

// Errors beyond the data sheet.
struct ImuImperfections {
  // Each axis leans towards each of the other two by a small angle, drawn once; rad, 1 sigma.
  double gyro_misalignment = 0.0, accel_misalignment = 0.0;
  VibrationModel vibration;
  // The temperature rises after the start by temperature_rise_k (1 - exp(-t / temperature_time_s));
  // the biases follow by coefficients drawn once, 1 sigma.
  double temperature_rise_k = 0.0, temperature_time_s = 600.0;
  double gyro_bias_per_k = 0.0, accel_bias_per_k = 0.0;  // rad/s/K, m/s^2/K
  // Quantum of the increments; the remainder goes into the next sample. 0: none.
  double gyro_quantum = 0.0, accel_quantum = 0.0;  // rad, m/s
};

// InertialSensor measures samples in order of time.
class InertialSensor {
 public:
  // `seed` is for SensorErrors, `random` for all other errors.
  InertialSensor(const ImuErrorModel& model, const ImuImperfections& imperfections, double rate_hz,
                 std::uint64_t seed, GaussianGenerator random);

  // Disturbs samples in order, all of one rate. `speed_m_s` is the vehicle's, for the vibration.
  ImuSample measure(const ImuSample& ideal, double speed_m_s);

  bool needs_speed() const { return imperfections_.vibration.active(); }

 private:
  ImuImperfections imperfections_;
  SensorErrors errors_;
  Eigen::Matrix3d gyro_axes_, accel_axes_;  // rows: the sensitive axes in the body frame
  Eigen::Vector3d gyro_per_k_, accel_per_k_;
  Vibration vibration_;
  double elapsed_s_ = 0.0;
  Eigen::Vector3d angle_left_ = Eigen::Vector3d::Zero(), velocity_left_ = Eigen::Vector3d::Zero();
};

}  // namespace leonav
