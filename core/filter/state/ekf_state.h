// This header defines the order of the filter's error state, its covariance, clocks and
// ambiguities.
#pragma once
#include <Eigen/Core>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "core/base/bounded_matrix.h"
#include "core/base/capacity.h"
#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"

namespace leonav {

// Error state, in this order (all errors are "true minus estimate"; position, velocity and attitude
// errors in ECEF: C_eb_true = exp([attitude x]) C_eb):
//   position 3, velocity 3, attitude 3, gyro bias 3, accelerometer bias 3, gyro scale 3,
//   accelerometer scale 3, clock offset per time system 4 (m), clock drift per time system 4 (m/s),
//   zenith wet delay beyond the modelled one (m), the carriers' clock against the codes' (m),
//   zenith ionosphere delay on L1 beyond the modelled one (m), the vehicle constants as far
//   as they are estimated, and one ambiguity (m) per carrier arc under way.
// The constant-velocity and static models keep the same order; the states they lack have zero
// covariance and take no correction.
namespace ekf_index {
inline constexpr int kPosition = 0, kVelocity = 3, kAttitude = 6, kGyroBias = 9, kAccelBias = 12,
                     kGyroScale = 15, kAccelScale = 18, kClock = 21, kClockDrift = 25,
                     kWetDelay = 29, kCarrierClock = 30, kIonosphere = 31,
                     kSize = 32;  // states that come and go follow
inline constexpr int kInsSize = 21;
static_assert(kClockDrift == kClock + static_cast<int>(kMaxSystemTimes) &&
                  kWetDelay == kClockDrift + static_cast<int>(kMaxSystemTimes),
              "one clock offset and drift per system time, here and wherever blocks of four stand");
// The vehicle constants follow from kSize on, as many as are estimated: the direction of travel in
// body axes (yaw and pitch, rad), the relative scale error of the odometer, the antenna's lever arm
// in body axes beyond the configured one (3, m), and by how much later than its corrected stamp the
// IMU measures (s). A constant that is not estimated, before others that are, has no variance and
// takes no correction.
inline constexpr int kTravelYaw = 0, kTravelPitch = 1, kOdometerScale = 2, kLeverArm = 3,
                     kTimeOffset = 6, kMaxVehicle = 7;
// The last four of them move the antenna.
inline constexpr int kAntennaConstants = kMaxVehicle - kLeverArm;
inline constexpr int kMaxCore = kSize + kMaxVehicle;  // states before the ambiguities
inline constexpr int kMaxSize = kMaxCore + static_cast<int>(kMaxArcs);
}  // namespace ekf_index

// A square matrix over all states at hand, in storage of fixed capacity.
using EkfCovariance = BoundedMatrix<ekf_index::kMaxSize, ekf_index::kMaxSize>;
// One number per state.
using EkfCorrection = BoundedVector<ekf_index::kMaxSize>;
// One number per state before vehicle constants and ambiguities: the Jacobian row of a measurement,
// which has a one for its own ambiguity beside.
using EkfVector = Eigen::Matrix<double, ekf_index::kSize, 1>;
// Covariance of gyro bias, accelerometer bias, gyro scale and accelerometer scale, in this order.
using ImuErrorCovariance = Eigen::Matrix<double, 12, 12>;

using VehicleConstants = boost::container::static_vector<double, ekf_index::kMaxVehicle>;

struct ClockState {
  Eigen::Vector4d offset_m = Eigen::Vector4d::Zero();
  Eigen::Vector4d drift_m_s = Eigen::Vector4d::Zero();
};

// The clocks of systems observed so far, per System. An unobserved one has zero covariance and
// takes no correction until its first measurement starts it. A known offset implies a known drift.
struct ClockFlags {
  std::array<bool, kMaxSystemTimes> offset{};
  std::array<bool, kMaxSystemTimes> drift{};
};

// The constant of one carrier arc, m: carrier phase minus the code's model.
struct Ambiguity {
  std::uint32_t arc = 0;
  SatelliteId satellite;
  double value_m = 0.0;
  double random_walk = 0.0;  // m/sqrt(s)
  GpsTime started, last_used;
  int rejected = 0;  // in so many epochs in a row
  // Where the arc was joined to earlier ones: the probability that one of the joins is wrong, and
  // the change of the value if it is, m.
  double wrong_join_probability = 0.0, wrong_join_m = 0.0;
};
// Index-parallel to the error state from FilterState::first_ambiguity() on.
using Ambiguities = boost::container::static_vector<Ambiguity, kMaxArcs>;

}  // namespace leonav
