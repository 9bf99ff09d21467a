// What the filter expects of a code, carrier or Doppler measurement, with its Jacobian.
#pragma once
#include <Eigen/Core>

#include "core/filter/state/ekf_state.h"
#include "core/gnss/measurement/measurement.h"
#include "core/inertial/strapdown/nav_state.h"

namespace leonav {

using AntennaVector = Eigen::Matrix<double, ekf_index::kAntennaConstants, 1>;
using AntennaSlopes = Eigen::Matrix<double, 3, ekf_index::kAntennaConstants>;

// The antenna as it follows from the inertial state and the lever arm:
//   p_a = p + C_eb l
//   v_a = v + C_eb (omega_ib_b x l) - omega_ie x (C_eb l)
// Without attitude (constant-velocity model) the state is the antenna's own.
// An IMU that has measured later than stamped by dt (not counted where 0) has the state at dt after
// the measurement:
//   p_a <- p_a - dt v_a + dt^2/2 a,  v_a <- v_a - dt a
// with the acceleration a of the IMU (that of the antenna about it, a decimetre per second squared
// in a turn, times dt, is left out).
struct AntennaMotion {
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();
  // d p_e / d attitude, d v_e / d attitude, gyro bias, gyro scale; zero without attitude.
  Eigen::Matrix3d d_p_d_attitude = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d d_v_d_attitude = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d d_v_d_gyro_bias = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d d_v_d_gyro_scale = Eigen::Matrix3d::Zero();
  double time_offset_s = 0.0;
  // Where lever arm and time offset are estimated: how they move position and velocity (three
  // columns and one), at time offset zero.
  bool estimated = false;
  AntennaSlopes d_p_d_constants = AntennaSlopes::Zero();
  AntennaSlopes d_v_d_constants = AntennaSlopes::Zero();
};

// `measured_rate_b`: the gyros' rate with their errors still in it, rad/s.
AntennaMotion antenna_motion(const NavState& state, const Eigen::Vector3d& measured_rate_b,
                             const Eigen::Vector3d& lever_arm_b, bool has_attitude);

// Likewise with what is estimated of lever arm and time offset. `acceleration_e`: of the IMU
// against the Earth, m/s^2.
AntennaMotion antenna_motion(const NavState& state, const Eigen::Vector3d& measured_rate_b,
                             const Eigen::Vector3d& configured_lever_arm_b, bool has_attitude,
                             const VehicleConstants& vehicle,
                             const Eigen::Vector3d& acceleration_e);

// As estimated; zero where it is not.
Eigen::Vector3d lever_arm_correction(const VehicleConstants& vehicle);
double time_offset_of(const VehicleConstants& vehicle);

struct MeasurementPrediction {
  double value = 0.0;                 // m or m/s
  EkfVector row = EkfVector::Zero();  // d value / d error state
  // d value / d lever arm and time offset; zero where they are not estimated.
  AntennaVector constants = AntennaVector::Zero();
};

// `wet_delay_m`: at zenith, beyond the modelled one. `carrier_clock_m`: of the carriers against
// the codes. A carrier is predicted without its ambiguity.
MeasurementPrediction predict_measurement(const Measurement& measurement,
                                          const SatelliteInView& satellite,
                                          const AntennaMotion& antenna, const ClockState& clocks,
                                          double wet_delay_m, double carrier_clock_m);

}  // namespace leonav
