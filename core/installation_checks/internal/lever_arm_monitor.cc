#include "core/installation_checks/internal/lever_arm_monitor.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/earth/ellipsoid.h"
#include "core/earth/gravity.h"
#include "core/earth/rotation.h"

namespace leonav {
namespace {

constexpr double kRateTime_s = 0.05;
constexpr double kShortestPair_s = 0.5, kLongestPair_s = 3.0;
constexpr double kMinPairImuShare = 0.95;
constexpr double kOutlier_m_s = 3.0;
constexpr double kPrior = 0.01;  // rad^2/s^2 in the normal equations, for axes that no turn excites
constexpr int kMinRotatingSeconds = 20;
constexpr double kKnownSigma_m = 0.12;
constexpr double kMinOff_m = 0.6, kClearSigmas = 8.0;
constexpr double kSignShare = 0.4;  // largest distance to the arm with other signs, as a share

}  // namespace

LeverArmMonitor::LeverArmMonitor(const Eigen::Vector3d& lever_arm_b) : lever_arm_b_(lever_arm_b) {}

void LeverArmMonitor::clear() { *this = LeverArmMonitor(lever_arm_b_); }

void LeverArmMonitor::begin_second() {
  q_0b_.setIdentity();
  velocity_0_.setZero();
  imu_s_ = 0.0;
  has_start_ = false;
}

void LeverArmMonitor::add(const ImuSample& sample) {
  const double dt = sample.interval_s();
  velocity_0_ +=
      q_0b_ * (sample.delta_velocity_b + 0.5 * sample.delta_theta_b.cross(sample.delta_velocity_b));
  q_0b_ = (q_0b_ * quaternion_from_rotation_vector(sample.delta_theta_b)).normalized();
  rate_b_ += std::min(1.0, dt / kRateTime_s) * (sample.delta_theta_b / dt - rate_b_);
  imu_s_ += dt;
}

void LeverArmMonitor::end_second(GpsTime time, const PointSolution* point,
                                 const Eigen::Quaterniond* q_eb) {
  const bool known = point != nullptr && point->has_velocity && q_eb != nullptr &&
                     q_eb->coeffs().allFinite() && point->v_e.allFinite();
  const double dt = has_start_ ? seconds_between(time, start_) : 0.0;
  if (known && dt > kShortestPair_s && dt < kLongestPair_s && imu_s_ > kMinPairImuShare * dt) {
    const Eigen::Matrix3d C_10 = q_0b_.conjugate().toRotationMatrix();
    const Eigen::Vector3d omega_ie_e(0.0, 0.0, kEarthRotationRate);
    const Eigen::Vector3d gravity = gravity_e(point->p_e) - 2.0 * omega_ie_e.cross(point->v_e);
    const Eigen::Vector3d unexplained_b =
        q_eb->conjugate() * (point->v_e - start_v_e_ - gravity * dt) - C_10 * velocity_0_;
    const Eigen::Matrix3d swing = skew(rate_b_) - C_10 * skew(start_rate_b_);
    const Eigen::Vector3d left_b = unexplained_b - swing * lever_arm_b_;
    if (unexplained_b.allFinite() && left_b.norm() < kOutlier_m_s) {
      Eigen::Matrix<double, 3, 6> design;
      design << swing, dt * Eigen::Matrix3d::Identity();
      normal_ += design.transpose() * design;
      right_ += design.transpose() * left_b;
      squares_ += left_b.squaredNorm();
      ++seconds_;
    }
  }
  begin_second();
  has_start_ = known;
  if (!known) return;
  start_ = time;
  start_v_e_ = point->v_e;
  start_rate_b_ = rate_b_;
}

LeverArmMonitor::Fit LeverArmMonitor::fit() const {
  Matrix6d normal = normal_;
  normal.diagonal().array() += kPrior;
  const Matrix6d inverse = normal.ldlt().solve(Matrix6d::Identity());
  const Vector6d solution = inverse * right_;
  const double left = std::max(0.0, squares_ - solution.dot(right_));
  const double variance = left / (3.0 * seconds_ - 6.0);
  return {lever_arm_b_ + solution.head<3>(),
          std::sqrt(variance * std::max(inverse(0, 0), inverse(1, 1)))};
}

bool LeverArmMonitor::is_known() const {
  return seconds_ >= kMinRotatingSeconds && fit().sigma < kKnownSigma_m;
}

ConventionFinding LeverArmMonitor::evaluate() const {
  if (seconds_ < kMinRotatingSeconds) return {};
  const Fit found = fit();
  const Eigen::Vector2d configured = lever_arm_b_.head<2>(), measured = found.arm_b.head<2>();
  const double off_m = (measured - configured).norm();
  const bool clear = off_m > kMinOff_m && off_m > kClearSigmas * found.sigma;
  if (!clear) return {};
  for (const Eigen::Vector2d& signs :
       {Eigen::Vector2d(-1.0, -1.0), Eigen::Vector2d(-1.0, 1.0), Eigen::Vector2d(1.0, -1.0)}) {
    if ((measured - signs.cwiseProduct(configured)).norm() < kSignShare * off_m)
      return {Convention::kLeverArmSign, off_m};
  }
  // A mistake of the signs may still become certain.
  return found.sigma < kKnownSigma_m ? ConventionFinding{Convention::kLeverArm, off_m}
                                     : ConventionFinding();
}

}  // namespace leonav
