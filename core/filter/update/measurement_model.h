// This header predicts code, carrier phase and Doppler from the filter's state, with the Jacobian.
#pragma once
#include <Eigen/Core>

#include "core/filter/state/ekf_state.h"
#include "core/gnss/measurement/measurement.h"
#include "core/inertial/strapdown/nav_state.h"

namespace leonav {

using AntennaVector = Eigen::Matrix<double, ekf_index::kAntennaConstants, 1>;
using AntennaSlopes = Eigen::Matrix<double, 3, ekf_index::kAntennaConstants>;

// Position and velocity of the antenna follow from the inertial state and the lever arm l:
//   p_a = p + C_eb l
//   v_a = v + C_eb (omega_ib_b x l) - omega_ie x (C_eb l)
// Without attitude (constant-velocity model) the state is that of the antenna. An IMU that measures
// dt later than stamped gives the state dt after the measurement:
//   p_a <- p_a - dt v_a + dt^2/2 a,  v_a <- v_a - dt a
// with the acceleration a of the IMU. That of the antenna about the IMU, 0.1 m/s^2 in a turn, is
// neglected.
struct AntennaMotion {
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();
  // Derivatives of p_e by attitude, and of v_e by attitude, gyro bias and gyro scale; zero without
  // attitude.
  Eigen::Matrix3d d_p_d_attitude = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d d_v_d_attitude = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d d_v_d_gyro_bias = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d d_v_d_gyro_scale = Eigen::Matrix3d::Zero();
  double time_offset_s = 0.0;
  // If lever arm and time offset are estimated: derivatives of position and velocity by them (three
  // columns and one), at time offset zero.
  bool estimated = false;
  AntennaSlopes d_p_d_constants = AntennaSlopes::Zero();
  AntennaSlopes d_v_d_constants = AntennaSlopes::Zero();
};

// Computes it from the configured lever arm alone. `measured_rate_b`: rate of the gyros, errors not
// removed, rad/s.
AntennaMotion antenna_motion(const NavState& state, const Eigen::Vector3d& measured_rate_b,
                             const Eigen::Vector3d& lever_arm_b, bool has_attitude);

// Computes it with the estimated lever arm and time offset. `acceleration_e`: of the IMU against
// the Earth, m/s^2.
AntennaMotion antenna_motion(const NavState& state, const Eigen::Vector3d& measured_rate_b,
                             const Eigen::Vector3d& configured_lever_arm_b, bool has_attitude,
                             const VehicleConstants& vehicle,
                             const Eigen::Vector3d& acceleration_e);

// Return the estimated lever arm correction (body axes, m) and time offset (s); zero if they are
// not estimated.
Eigen::Vector3d lever_arm_correction(const VehicleConstants& vehicle);
double time_offset_of(const VehicleConstants& vehicle);

struct MeasurementPrediction {
  double value = 0.0;                 // m or m/s
  EkfVector row = EkfVector::Zero();  // d value / d error state
  // d value / d lever arm and time offset; zero where they are not estimated.
  AntennaVector constants = AntennaVector::Zero();
};

// Predicts one measurement (core/gnss/measurement/measurement.h has the model). `wet_delay_m` and
// `ionosphere_m`: at zenith, beyond the modelled ones. `carrier_clock_m`: clock of the carriers
// minus that of the codes. A carrier is predicted without its ambiguity.
MeasurementPrediction predict_measurement(const MeasuredObservable& measurement,
                                          const SatelliteGeometry& satellite,
                                          const AntennaMotion& antenna, const ClockState& clocks,
                                          double wet_delay_m, double carrier_clock_m,
                                          double ionosphere_m);

}  // namespace leonav
