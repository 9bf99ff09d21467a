// What the way a vehicle moves tells of its state, as scalar measurements.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <numbers>

#include "core/filter/state/filter_state.h"
#include "core/inertial/strapdown/nav_state.h"

namespace leonav {

// The components that constraints have, and a set of them.
enum class MotionComponent : std::uint8_t {
  kSide = 0,         // m/s, of the point that does not slide
  kVertical = 1,     // likewise
  kVelocity = 2,     // three, m/s
  kAngularRate = 5,  // three, rad/s
  kOdometer = 8,     // m/s, along the direction of travel
};
using MotionComponents = std::uint16_t;

// Of the states before the ambiguities, with all of the vehicle's constants.
using ConstraintVector = Eigen::Matrix<double, ekf_index::kSize + ekf_index::kMaxVehicle, 1>;

// One component of one constraint.
struct MotionMeasurement {
  int component = 0;         // its bit in MotionComponents
  double observation = 0.0;  // m/s, of a rate rad/s
  double residual = 0.0;     // that less what is predicted
  double variance = 0.0;
  ConstraintVector row = ConstraintVector::Zero();
  // By Ekf::constrain: with what the components before it have told, and what all have left of it.
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
// `measured_rate_b`: the gyros', errors not removed, rad/s. `point_b`: from the IMU, m. Groves,
// Principles of GNSS, Inertial, and Multisensor Integrated Navigation Systems, 2013, 15.1.
BodyVelocity body_velocity(const NavState& state, const Eigen::Vector3d& measured_rate_b,
                           const Eigen::Vector3d& point_b);

// Forward, side and down axes of the way the vehicle goes, in body axes (columns), and their
// slopes. `yaw`, `pitch`: of the direction of travel in body axes, rad; right-handed about down and
// side.
struct TravelAxes {
  Eigen::Matrix3d C_bv, d_yaw, d_pitch;
};
TravelAxes travel_axes(double yaw, double pitch);
// Of the vehicle's constants; the body's own axes where these are not estimated.
TravelAxes travel_axes(const VehicleConstants& vehicle);

// Of a point along the direction of travel, m/s; `point_b` from the IMU, m.
double forward_speed(const FilterState& state, const Eigen::Vector3d& measured_rate_b,
                     const Eigen::Vector3d& point_b);

// What gyros at rest show less what they should: their bias and the Earth's rate (rad/s).
struct StationaryGyroResidual {
  Eigen::Vector3d residual_b = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, ekf_index::kSize, 3> columns =
      Eigen::Matrix<double, ekf_index::kSize, 3>::Zero();
};
StationaryGyroResidual stationary_gyro_residual(const NavState& state,
                                                const Eigen::Vector3d& measured_rate_b);

struct MotionConstraintConfig {
  static constexpr double kDegree = std::numbers::pi / 180.0;

  bool non_holonomic = false;                         // neither side nor vertical velocity
  bool zero_velocity = false;                         // nor any other while it stands, nor a turn
  double interval_s = 0.2;                            // from one instant to the next
  Eigen::Vector3d point_b = Eigen::Vector3d::Zero();  // m from the IMU: what does not slide
  // 1 sigma at one instant. What the vehicle makes of it is alike from one to the next, so these
  // are larger than what it really does.
  double side_sigma = 0.1, vertical_sigma = 0.1;   // m/s
  double slip_per_acceleration = 0.573 * kDegree;  // rad of side slip per m/s^2 across, 1 sigma
  double standing_velocity_sigma = 0.02;           // m/s
  double standing_rate_sigma = 0.0115 * kDegree;   // rad/s
  double gate = 4.0;  // sigmas; what is further from the prediction is left out
  // An odometer, used as far as its messages come.
  bool odometer = false;
  Eigen::Vector3d odometer_point_b = Eigen::Vector3d::Zero();  // m from the IMU: what it counts for
  double odometer_sigma = 0.05;       // m/s, 1 sigma at one instant, alike from one to the next
  double odometer_resolution = 0.02;  // m, of one pulse

  bool operator==(const MotionConstraintConfig&) const = default;
};

// An odometer's word at one instant: a mean speed, and what has changed since by the IMU.
struct OdometerSpeed {
  bool known = false;
  double mean_m_s = 0.0;    // by the odometer, over the intervals since the instant before
  double change_m_s = 0.0;  // speed at the instant less the true mean over those intervals
  double variance = 0.0;    // of the mean, of counting whole pulses, (m/s)^2
};

// What is known of the motion at one instant.
struct ConstraintInstant {
  GpsTime time;
  bool standing = false;
  Eigen::Vector3d stationary_rate_b = Eigen::Vector3d::Zero();  // measured mean, rad/s
  OdometerSpeed odometer;
  MotionComponents used = 0;  // by the filter
  // Beyond the constraints' own variances, (m/s)^2: where speed and direction are both badly known,
  // their product, which no Jacobian sees, is what the vehicle seems to slide by.
  double side_second_order_variance = 0.0, vertical_second_order_variance = 0.0;
};

using ConstraintInstants =
    boost::container::static_vector<ConstraintInstant, kMaxConstraintInstants>;

// The components that hold at the instant, with the state as it is then. An odometer shows its mean
// speed times 1 + VehicleConstants[kOdometerScale]; the change since is taken as certain, for what
// it depends on (tilt, accelerometer bias) moves it by a tenth of a second's worth.
void motion_measurements(const MotionConstraintConfig& config, const ConstraintInstant& instant,
                         const FilterState& state, const Eigen::Vector3d& measured_rate_b,
                         MotionMeasurements* measurements);

}  // namespace leonav
