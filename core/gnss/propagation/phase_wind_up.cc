#include "core/gnss/propagation/phase_wind_up.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace leonav {

double phase_wind_up_cycles(const Eigen::Vector3d& p_sat_e, const Eigen::Matrix3d& C_es,
                            const Eigen::Vector3d& p_a_e, const Eigen::Matrix3d& C_er,
                            double previous) {
  const Eigen::Vector3d path = p_a_e - p_sat_e;
  const double range = path.norm();
  if (!(range > 0.0)) return previous;
  const Eigen::Vector3d k = path / range;
  // Effective dipoles (Wu et al., eqs. 25, 26); the antenna's second dipole points to the left.
  const Eigen::Vector3d receiver_x = C_er.col(0);
  const Eigen::Vector3d receiver_y = -C_er.col(1);
  const Eigen::Vector3d satellite_x = C_es.col(0);
  const Eigen::Vector3d satellite_y = C_es.col(1);
  const Eigen::Vector3d d_r = receiver_x - k * k.dot(receiver_x) + k.cross(receiver_y);
  const Eigen::Vector3d d_s = satellite_x - k * k.dot(satellite_x) - k.cross(satellite_y);
  // The angle follows from its sine and cosine, which is well conditioned everywhere (eq. 30 has an
  // arc cosine).
  const double angle = std::atan2(k.dot(d_s.cross(d_r)), d_s.dot(d_r));
  const double cycles = angle / (2.0 * std::numbers::pi);
  const double result = cycles + std::round(previous - cycles);
  return std::isfinite(result) ? result : previous;
}

}  // namespace leonav
