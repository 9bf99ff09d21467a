#include "core/filter/process/constant_velocity.h"

#include "core/earth/ellipsoid.h"

namespace leonav {

using namespace ekf_index;
using Eigen::Matrix3d;

void propagate_constant_velocity(const Eigen::Vector3d& p_e, double horizontal, double vertical,
                                 double dt, EkfCovariance* covariance) {
  EkfCovariance& P = *covariance;
  P.middleRows<3>(kPosition) += dt * P.middleRows<3>(kVelocity);
  P.middleCols<3>(kPosition) += dt * P.middleCols<3>(kVelocity);

  const Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(p_e));
  const Eigen::Vector3d densities{horizontal * horizontal, horizontal * horizontal,
                                  vertical * vertical};
  const Matrix3d S = C_ne.transpose() * densities.asDiagonal() * C_ne;
  P.block<3, 3>(kPosition, kPosition) += dt * dt * dt / 3.0 * S;
  P.block<3, 3>(kPosition, kVelocity) += dt * dt / 2.0 * S;
  P.block<3, 3>(kVelocity, kPosition) += dt * dt / 2.0 * S;
  P.block<3, 3>(kVelocity, kVelocity) += dt * S;
}

}  // namespace leonav
