#include "core/filter/update/motion_constraint.h"

#include <cmath>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/filter/update/measurement_model.h"

namespace leonav {

using namespace ekf_index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

BodyVelocity body_velocity(const NavState& state, const Vector3d& measured_rate_b,
                           const Vector3d& point_b) {
  const AntennaMotion point = antenna_motion(state, measured_rate_b, point_b, true);
  const Matrix3d C_be = state.q_eb.toRotationMatrix().transpose();
  BodyVelocity velocity;
  velocity.v_b = C_be * point.v_e;
  auto& columns = velocity.columns;
  columns.middleRows<3>(kVelocity) = C_be.transpose();
  columns.middleRows<3>(kAttitude) = (C_be * (point.d_v_d_attitude + skew(point.v_e))).transpose();
  columns.middleRows<3>(kGyroBias) = (C_be * point.d_v_d_gyro_bias).transpose();
  columns.middleRows<3>(kGyroScale) = (C_be * point.d_v_d_gyro_scale).transpose();
  return velocity;
}

StationaryGyroResidual stationary_gyro_residual(const NavState& state,
                                                const Vector3d& measured_rate_b) {
  const Matrix3d C_be = state.q_eb.toRotationMatrix().transpose();
  const Vector3d omega_ie{0.0, 0.0, kEarthRotationRate};
  const Vector3d earth_b = C_be * omega_ie;
  const Vector3d scale = 1.0 + state.errors.gyro_scale.array();
  StationaryGyroResidual rate;
  rate.residual_b = measured_rate_b - scale.cwiseProduct(earth_b) - state.errors.gyro_bias_b;
  rate.columns.middleRows<3>(kGyroBias).setIdentity();
  rate.columns.middleRows<3>(kGyroScale) = earth_b.asDiagonal();
  rate.columns.middleRows<3>(kAttitude) = (scale.asDiagonal() * C_be * skew(omega_ie)).transpose();
  return rate;
}

TravelAxes travel_axes(double yaw, double pitch) {
  const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch);
  TravelAxes axes;
  axes.C_bv << cp * cy, -sy, sp * cy, cp * sy, cy, sp * sy, -sp, 0.0, cp;
  axes.d_yaw << -cp * sy, -cy, -sp * sy, cp * cy, -sy, sp * cy, 0.0, 0.0, 0.0;
  axes.d_pitch << -sp * cy, 0.0, cp * cy, -sp * sy, 0.0, cp * sy, -cp, 0.0, -sp;
  return axes;
}

TravelAxes travel_axes(const VehicleConstants& vehicle) {
  if (vehicle.size() <= kTravelPitch) return travel_axes(0.0, 0.0);
  return travel_axes(vehicle[kTravelYaw], vehicle[kTravelPitch]);
}

double forward_speed(const FilterState& state, const Vector3d& measured_rate_b,
                     const Vector3d& point_b) {
  const AntennaMotion point = antenna_motion(state.nav, measured_rate_b, point_b, true);
  return travel_axes(state.vehicle).C_bv.col(0).dot(state.nav.q_eb.conjugate() * point.v_e);
}

namespace {

// Along the direction of travel.
MotionMeasurement odometer_measurement(const MotionConstraintConfig& config,
                                       const OdometerSpeed& odometer, const FilterState& whole,
                                       const Vector3d& measured_rate_b) {
  const BodyVelocity velocity = body_velocity(whole.nav, measured_rate_b, config.odometer_point_b);
  const TravelAxes axes = travel_axes(whole.vehicle);
  const double speed = axes.C_bv.col(0).dot(velocity.v_b);
  const double mean = speed - odometer.change_m_s;
  const double scale = whole.vehicle.size() > kOdometerScale ? whole.vehicle[kOdometerScale] : 0.0;
  MotionMeasurement measurement;
  measurement.component = static_cast<int>(MotionComponent::kOdometer);
  measurement.observation = odometer.mean_m_s;
  measurement.residual = odometer.mean_m_s - (1.0 + scale) * mean;
  measurement.variance = square(config.odometer_sigma) + odometer.variance;
  auto& row = measurement.row;
  row.head<kSize>() = (1.0 + scale) * (velocity.columns * axes.C_bv.col(0));
  row(kSize + kTravelYaw) = (1.0 + scale) * axes.d_yaw.col(0).dot(velocity.v_b);
  row(kSize + kTravelPitch) = (1.0 + scale) * axes.d_pitch.col(0).dot(velocity.v_b);
  row(kSize + kOdometerScale) = mean;
  return measurement;
}

}  // namespace

void motion_measurements(const MotionConstraintConfig& config, const ConstraintInstant& instant,
                         const FilterState& whole, const Vector3d& measured_rate_b,
                         MotionMeasurements* measurements) {
  const NavState& state = whole.nav;
  measurements->clear();
  const BodyVelocity velocity = body_velocity(state, measured_rate_b, config.point_b);
  const auto add = [&](MotionComponent first, int axis, double residual, double variance,
                       const EkfVector& row) -> MotionMeasurement& {
    MotionMeasurement& measurement = measurements->emplace_back();
    measurement.component = static_cast<int>(first) + axis;
    measurement.residual = residual;
    measurement.variance = variance;
    measurement.row.head<kSize>() = row;
    return measurement;
  };
  if (instant.standing && config.zero_velocity) {
    const StationaryGyroResidual rate = stationary_gyro_residual(state, instant.stationary_rate_b);
    for (int axis = 0; axis < 3; ++axis) {
      add(MotionComponent::kVelocity, axis, -velocity.v_b(axis),
          square(config.standing_velocity_sigma), velocity.columns.col(axis));
      add(MotionComponent::kAngularRate, axis, rate.residual_b(axis),
          square(config.standing_rate_sigma), rate.columns.col(axis))
          .observation = instant.stationary_rate_b(axis);
    }
    return;
  }
  if (instant.odometer.known)
    measurements->push_back(odometer_measurement(config, instant.odometer, whole, measured_rate_b));
  if (!config.non_holonomic) return;
  const TravelAxes axes = travel_axes(whole.vehicle);
  const Vector3d v = axes.C_bv.transpose() * velocity.v_b;  // forward, side, down
  const auto zero = [&](MotionComponent component, int axis, double variance) {
    MotionMeasurement& measurement =
        add(component, 0, -v(axis), variance, velocity.columns * axes.C_bv.col(axis));
    measurement.row(kSize + kTravelYaw) = axes.d_yaw.col(axis).dot(velocity.v_b);
    measurement.row(kSize + kTravelPitch) = axes.d_pitch.col(axis).dot(velocity.v_b);
  };
  const double across = measured_rate_b.z() * v.x();  // m/s^2
  const double slip = config.slip_per_acceleration * across * v.x();
  zero(MotionComponent::kSide, 1,
       square(config.side_sigma) + square(slip) + instant.side_second_order_variance);
  zero(MotionComponent::kVertical, 2,
       square(config.vertical_sigma) + instant.vertical_second_order_variance);
}

}  // namespace leonav
