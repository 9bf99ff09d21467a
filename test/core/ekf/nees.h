// What the tests of the filter's consistency share: normalized estimation errors squared (NEES)
// over many runs (Bar-Shalom, Li, Kirubarajan 2001, 5.4.2).
#pragma once
#include <Eigen/Dense>
#include <cmath>

#include "synthetic.h"

namespace leonav::synthetic {

inline constexpr int kRuns = 100;

// 95 % band of the mean of kRuns chi-square variables with 3 degrees: 300 degrees over 100,
// quantiles 253.9 and 349.9 (Wilson-Hilferty).
inline constexpr double kLeastNees3 = 2.54, kMostNees3 = 3.50;

// `P` of the error's size.
template <typename Error, typename Covariance>
double nees(const Error& error, const Covariance& P) {
  return error.dot(P.ldlt().solve(error));
}

// Moves the truth over a second of white acceleration as the constant-velocity model has it:
// velocity and position parts with their correlation.
inline void move_a_second(const EkfConfig& config, const Eigen::Matrix3d& C_en, Truth* truth,
                          Generator* noise) {
  const Eigen::Vector3d density{config.acceleration_noise_horizontal,
                                config.acceleration_noise_horizontal,
                                config.acceleration_noise_vertical};
  const Eigen::Vector3d a = noise->normal3().cwiseProduct(density);
  const Eigen::Vector3d b = noise->normal3().cwiseProduct(density);
  truth->p_antenna_e += truth->v_antenna_e + C_en * (0.5 * a + b / std::sqrt(12.0));
  truth->v_antenna_e += C_en * a;
}

}  // namespace leonav::synthetic
