// A sensor as it is built: besides the data sheet's noise and biases what mounting, temperature,
// shaking and its converter do. The estimator knows nothing of these: they are what its model
// lacks.
#pragma once
#include <Eigen/Core>

#include "tools/motion/sensor_errors.h"
#include "tools/motion/vibration.h"

namespace leonav {

struct ImuImperfections {
  // Each axis leans towards each of the other two by a small angle, drawn once; rad, 1 sigma.
  double gyro_misalignment = 0.0, accel_misalignment = 0.0;
  VibrationModel vibration;
  // It warms up after the start by temperature_rise_k (1 - exp(-t / temperature_time_s)); the
  // biases follow by coefficients drawn once, 1 sigma.
  double temperature_rise_k = 0.0, temperature_time_s = 600.0;
  double gyro_bias_per_k = 0.0, accel_bias_per_k = 0.0;  // rad/s/K, m/s^2/K
  // Steps of the increments; what is cut off goes into the next sample. 0: none.
  double gyro_quantum = 0.0, accel_quantum = 0.0;  // rad, m/s
};

class InertialSensor {
 public:
  // `seed` is that of SensorErrors; `random` of all others.
  InertialSensor(const ImuErrorModel& model, const ImuImperfections& imperfections, double rate_hz,
                 std::uint64_t seed, GaussianGenerator random);

  // Samples in order, of one rate. `speed_m_s`: of the vehicle, for the vibration.
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
