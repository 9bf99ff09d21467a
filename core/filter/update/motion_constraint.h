// This header turns how a vehicle can move into scalar measurements of the filter's state: wheels
// do not slide sideways, a standing vehicle has no velocity, an odometer shows the speed.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "core/base/angle.h"
#include "core/filter/state/filter_state.h"
#include "core/inertial/strapdown/nav_state.h"

namespace leonav {

// The components of constraints, and a set of them as bits.
enum class MotionComponent : std::uint8_t {
  kSide = 0,         // m/s, of the point that does not slide
  kVertical = 1,     // m/s, of the same point
  kVelocity = 2,     // three, m/s
  kAngularRate = 5,  // three, rad/s
  kOdometer = 8,     // m/s, along the direction of travel
};
using MotionComponents = std::uint16_t;

// Jacobian row over the states before the ambiguities, with all vehicle constants.
using ConstraintVector = Eigen::Matrix<double, ekf_index::kSize + ekf_index::kMaxVehicle, 1>;

// One component of one constraint.
struct MotionMeasurement {
  int component = 0;         // its bit in MotionComponents
  double observation = 0.0;  // m/s, of a rate rad/s
  double residual = 0.0;     // observation minus prediction
  double variance = 0.0;
  ConstraintVector row = ConstraintVector::Zero();
  // Set by StateEstimate::constrain(): innovation after the components before it, its variance, and
  // the residual after all of them.
  double innovation = 0.0, innovation_variance = 0.0, left = 0.0;
  bool used = false;
};
// The components of all constraints at one instant.
using MotionMeasurements = boost::container::static_vector<MotionMeasurement, 8>;

// Velocity of a point of the body relative to the Earth, in body axes (m/s), and its Jacobian.
struct BodyVelocity {
  Eigen::Vector3d v_b = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, ekf_index::kSize, 3> columns =
      Eigen::Matrix<double, ekf_index::kSize, 3>::Zero();  // transposed
};
// Returns v_b = C_be v_e + (omega_ib_b - omega_ie_b) x point_b. `measured_rate_b`: rate of the
// gyros, errors not removed, rad/s. `point_b`: from the IMU, m. Groves 2013, 15.1.
BodyVelocity body_velocity(const NavState& state, const Eigen::Vector3d& measured_rate_b,
                           const Eigen::Vector3d& point_b);

// Forward, side and down axes of travel in body axes (columns), and their derivatives by `yaw` and
// `pitch` of the direction of travel in body axes, rad, right-handed about down and side.
struct TravelAxes {
  Eigen::Matrix3d C_bv, d_yaw, d_pitch;
};
TravelAxes travel_axes(double yaw, double pitch);
// Returns those of the vehicle constants; the body axes where these are not estimated.
TravelAxes travel_axes(const VehicleConstants& vehicle);

// Returns the speed of a point along the direction of travel, m/s; `point_b` from the IMU, m.
double forward_speed(const FilterState& state, const Eigen::Vector3d& measured_rate_b,
                     const Eigen::Vector3d& point_b);

// Angular rate that gyros at rest measure, minus bias and the Earth's rate, rad/s.
struct StationaryGyroResidual {
  Eigen::Vector3d residual_b = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, ekf_index::kSize, 3> columns =
      Eigen::Matrix<double, ekf_index::kSize, 3>::Zero();
};
StationaryGyroResidual stationary_gyro_residual(const NavState& state,
                                                const Eigen::Vector3d& measured_rate_b);

struct MotionConstraintConfig {
  bool non_holonomic = false;                         // neither side nor vertical velocity
  bool zero_velocity = false;                         // at standstill: no velocity, no turn
  double interval_s = 0.2;                            // from one instant to the next
  Eigen::Vector3d point_b = Eigen::Vector3d::Zero();  // m from the IMU: what does not slide
  // 1 sigma at one instant. The vehicle's deviations are correlated from instant to instant, so
  // that these are larger than the real deviations.
  double side_sigma = 0.1, vertical_sigma = 0.1;   // m/s
  double slip_per_acceleration = 0.573 * kDegree;  // rad of side slip per m/s^2 across, 1 sigma
  double standing_velocity_sigma = 0.02;           // m/s
  double standing_rate_sigma = 0.0115 * kDegree;   // rad/s
  double gate = 4.0;  // sigmas; a component further from its prediction is excluded
  // An odometer, used whenever its messages arrive.
  bool odometer = false;
  Eigen::Vector3d odometer_point_b = Eigen::Vector3d::Zero();  // m from the IMU: what it counts for
  double odometer_sigma = 0.05;       // m/s, 1 sigma at one instant, correlated in time
  double odometer_resolution = 0.02;  // m, of one pulse

  bool operator==(const MotionConstraintConfig&) const = default;
};

// The speed at one instant by the odometer's mean and the IMU's change since then.
struct OdometerSpeed {
  bool known = false;
  double mean_m_s = 0.0;    // by the odometer, over the intervals since the instant before
  double change_m_s = 0.0;  // speed at the instant minus the mean over those intervals, by the IMU
  double variance = 0.0;    // of the mean, because whole pulses are counted, (m/s)^2
};

// The evidence about the motion at one instant.
struct ConstraintInstant {
  GpsTime time;
  bool standing = false;
  Eigen::Vector3d stationary_rate_b = Eigen::Vector3d::Zero();  // measured mean, rad/s
  OdometerSpeed odometer;
  MotionComponents used = 0;  // by the filter
  // Added to the constraints' own variances, (m/s)^2: where speed and direction are both uncertain,
  // the vehicle seems to slide by their product, a second-order term that no Jacobian contains.
  double side_second_order_variance = 0.0, vertical_second_order_variance = 0.0;
};

using ConstraintInstants =
    boost::container::static_vector<ConstraintInstant, kMaxConstraintInstants>;

// Writes the components that apply at the instant, linearized at `state`. An odometer shows its
// mean speed times 1 + VehicleConstants[kOdometerScale]. The change since then is taken as certain:
// the errors that it depends on (tilt, accelerometer bias) act over 0.1 s only.
void motion_measurements(const MotionConstraintConfig& config, const ConstraintInstant& instant,
                         const FilterState& state, const Eigen::Vector3d& measured_rate_b,
                         MotionMeasurements* measurements);

}  // namespace leonav
