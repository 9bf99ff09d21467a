// The tightly coupled extended Kalman filter: code and Doppler of every satellite against the
// inertial prediction (or a constant-velocity one).
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <memory>
#include <span>

#include "core/ekf/ekf_config.h"
#include "core/gnss/measurement.h"
#include "core/gnss/point_solution.h"
#include "core/ins/imu.h"
#include "core/ins/nav_state.h"

namespace leonav {

// Error state, in this order (all errors are "true minus estimate"; position, velocity and attitude
// errors in ECEF: C_eb_true = exp([attitude x]) C_eb):
//   position 3, velocity 3, attitude 3, gyro bias 3, accelerometer bias 3, gyro scale 3,
//   accelerometer scale 3, clock offset per time base 4 (m), clock drift per time base 4 (m/s).
// The constant-velocity model keeps the same order; the states it lacks have zero covariance and
// take no correction.
namespace ekf_index {
inline constexpr int kPosition = 0, kVelocity = 3, kAttitude = 6, kGyroBias = 9, kAccelBias = 12,
                     kGyroScale = 15, kAccelScale = 18, kClock = 21, kClockDrift = 25, kSize = 29;
inline constexpr int kInsSize = 21;
}  // namespace ekf_index

using EkfCovariance = Eigen::Matrix<double, ekf_index::kSize, ekf_index::kSize>;
using EkfVector = Eigen::Matrix<double, ekf_index::kSize, 1>;

struct ClockState {
  Eigen::Vector4d offset_m = Eigen::Vector4d::Zero();
  Eigen::Vector4d drift_m_s = Eigen::Vector4d::Zero();
};

// One scalar measurement as the filter treated it; index-parallel to
// MeasurementEpoch::measurements.
struct InnovationReport {
  double innovation = 0.0;
  double innovation_variance = 0.0;
  double test_ratio = 0.0;
  double weight_factor = 0.0;
  Reason reason = Reason::kUsed;
};

struct EkfUpdateResult {
  int used = 0;  // measurements with a factor above zero
  int code_offered = 0;
  int code_rejected = 0;
  double nis = 0.0;  // of the used ones
  boost::container::static_vector<InnovationReport, kMaxMeasurements> innovations;
};

class Ekf {
 public:
  Ekf(const EkfConfig& config, const ImuErrorModel& imu, const Eigen::Vector3d& lever_arm_b);

  // Starts from a point solution of the antenna; without attitude: constant-velocity model.
  void initialize(GpsTime time, const PointSolution& point);
  // Goes over to the inertial model: attitude and gyro bias given, covariance of position, velocity
  // and clocks kept; position moves from antenna to IMU centre by the lever arm.
  void set_attitude(const Eigen::Quaterniond& q_eb, const Eigen::Vector3d& sigma_rpy,
                    const Eigen::Vector3d& gyro_bias_b, bool gyro_bias_known);
  bool initialized() const { return initialized_; }
  bool has_attitude() const { return has_attitude_; }

  // Predicts to the end of `block`, then to `time` where the block leaves a hole (constant velocity
  // with grown uncertainty).
  void predict(std::span<const ImuSample> block, GpsTime time);

  // Uses epoch.measurements whose reason is kUsed. Joseph form; IGG-III on standardized
  // innovations.
  EkfUpdateResult update(const MeasurementEpoch& epoch);

  const NavState& state() const { return state_; }
  const ClockState& clocks() const { return clocks_; }
  const EkfCovariance& covariance() const { return covariance_; }
  Eigen::Vector3d antenna_position_e() const;
  Eigen::Vector3d antenna_velocity_e() const;

 private:
  EkfConfig config_;
  ImuErrorModel imu_;
  Eigen::Vector3d lever_arm_b_;
  NavState state_;
  ClockState clocks_;
  EkfCovariance covariance_ = EkfCovariance::Zero();
  Eigen::Vector3d omega_ib_b_ = Eigen::Vector3d::Zero();  // of the last sample, for the lever arm
  bool initialized_ = false;
  bool has_attitude_ = false;
};

}  // namespace leonav
