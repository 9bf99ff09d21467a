// The vehicle's constants, in Ekf.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/filter/ekf.h"
#include "core/filter/update/measurement_model.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kAccelerationTime = 0.05;  // s, of its fading mean
// An attitude known so well, rad, needs no further start of the constants.
constexpr double kConvergedTilt = 1e-3, kConvergedHeading = 4e-3;

}  // namespace

double Ekf::start_variance(int constant) const {
  return square(config_.vehicle.sigma[static_cast<std::size_t>(constant)]);
}

// What is known of the vehicle outlives the filter that found it; its correlations do not.
void Ekf::start_vehicle_constants(const VehicleConstants& before,
                                  const VehicleConstants& variances) {
  const int count = std::max(config_.vehicle.count, static_cast<int>(before.size()));
  covariance_.setZero(kSize + count, kSize + count);
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const bool known = index < before.size();
    state_.vehicle.push_back(known ? before[index] : 0.0);
    covariance_(kSize + i, kSize + i) = known ? variances[index] : start_variance(i);
  }
}

void Ekf::reset_vehicle_constants() {
  state_.vehicle.clear();
  start_tilt_sigma_ = start_heading_sigma_ = std::numeric_limits<double>::infinity();
}

// Makes room before the ambiguities.
void Ekf::estimate_constant(int constant) {
  const int known = static_cast<int>(state_.vehicle.size());
  if (!initialized_ || constant < known) return;
  const Eigen::Index before = kSize + known, more = constant + 1 - known;
  const Eigen::Index after = covariance_.rows() - before;
  EkfCovariance P = EkfCovariance::Zero(before + more + after, before + more + after);
  P.topLeftCorner(before, before) = covariance_.topLeftCorner(before, before);
  P.topRightCorner(before, after) = covariance_.topRightCorner(before, after);
  P.bottomLeftCorner(after, before) = covariance_.bottomLeftCorner(after, before);
  P.bottomRightCorner(after, after) = covariance_.bottomRightCorner(after, after);
  for (int i = known; i <= constant; ++i) {
    state_.vehicle.push_back(0.0);
    P(kSize + i, kSize + i) = start_variance(i);
  }
  covariance_ = P;
  process_.continuous = false;
}

VehicleConstants Ekf::vehicle_variances() const {
  VehicleConstants variances;
  for (int i = 0; i < static_cast<int>(state_.vehicle.size()); ++i)
    variances.push_back(covariance_(kSize + i, kSize + i));
  return variances;
}

// A mean, for an engine's shaking is not how the vehicle moves.
void Ekf::update_mean_acceleration(const Vector3d& v_before_e, double interval_s) {
  if (!config_.vehicle.moves_antenna()) return;
  const double share = std::min(1.0, interval_s / kAccelerationTime);
  acceleration_e_ += share * ((state_.nav.v_e - v_before_e) / interval_s - acceleration_e_);
}

// As long as measurements are used, position and velocity in the error state are those of the
// antenna's as far as lever arm and time offset move it: rows then need no columns for these. Any
// variance that the update adds to position or velocity is the same in both. `direction`: 1 before,
// -1 after.
void Ekf::apply_antenna_transform(const AntennaMotion& antenna, double direction) {
  if (!antenna.estimated) return;
  Eigen::Matrix<double, 6, kAntennaConstants> slopes;
  slopes << antenna.d_p_d_constants, antenna.d_v_d_constants;
  slopes *= direction;
  constexpr int kFirst = kSize + kLeverArm;
  EkfCovariance& P = covariance_;
  P.middleRows<6>(kPosition).noalias() +=
      slopes.lazyProduct(P.middleRows<kAntennaConstants>(kFirst));
  P.middleCols<6>(kPosition).noalias() +=
      P.middleCols<kAntennaConstants>(kFirst).lazyProduct(slopes.transpose());
}

Eigen::Matrix3d Ekf::antenna_covariance_e(
    int first, const Eigen::Matrix<double, 3, kAntennaConstants>& slopes) const {
  Matrix3d covariance = covariance_.block<3, 3>(first, first);
  if (!antenna().estimated) return covariance;
  constexpr int kFirst = kSize + kLeverArm;
  const Matrix3d cross = slopes * covariance_.block<kAntennaConstants, 3>(kFirst, first);
  covariance += cross + cross.transpose();
  covariance += slopes * covariance_.block<kAntennaConstants, kAntennaConstants>(kFirst, kFirst) *
                slopes.transpose();
  return covariance;
}

Eigen::Matrix3d Ekf::antenna_position_covariance_e() const {
  return antenna_covariance_e(kPosition, antenna().d_p_d_constants);
}

Eigen::Matrix3d Ekf::antenna_velocity_covariance_e() const {
  return antenna_covariance_e(kVelocity, antenna().d_v_d_constants);
}

// True where tilt or heading have become better known by the configured share.
bool Ekf::attitude_has_converged() {
  if (!has_attitude_) return false;
  const Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(state_.nav.p_e));
  const Matrix3d covariance =
      C_ne * covariance_.block<3, 3>(kAttitude, kAttitude) * C_ne.transpose();
  const Vector3d sigma = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const double tilt = std::max(kConvergedTilt, sigma.head<2>().maxCoeff());
  const double heading = std::max(kConvergedHeading, sigma.z());
  const double share = config_.vehicle.restart_share;
  const bool better = tilt < share * start_tilt_sigma_ || heading < share * start_heading_sigma_;
  if (!better) return false;
  start_tilt_sigma_ = std::min(start_tilt_sigma_, tilt);
  start_heading_sigma_ = std::min(start_heading_sigma_, heading);
  return true;
}

// As uncertain as at the start, the antenna where it is.
void Ekf::inflate_vehicle_constants() {
  const AntennaMotion motion = antenna();
  apply_antenna_transform(motion, 1.0);
  for (int i = 0; i < static_cast<int>(state_.vehicle.size()); ++i) {
    covariance_.row(kSize + i).setZero();
    covariance_.col(kSize + i).setZero();
    covariance_(kSize + i, kSize + i) = start_variance(i);
  }
  apply_antenna_transform(motion, -1.0);
  process_.continuous = false;
}

}  // namespace leonav
