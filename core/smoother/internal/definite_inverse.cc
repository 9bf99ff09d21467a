#include "core/smoother/internal/definite_inverse.h"

#include <Eigen/Cholesky>

namespace leonav {

bool invert(const EkfCovariance& matrix, EkfCovariance* inverse) {
  const Eigen::Index n = matrix.rows();
  const EkfCorrection scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return false;
  const EkfCovariance scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::LLT<EkfCovariance> root(scaled);
  if (root.info() != Eigen::Success) return false;
  EkfCovariance solved = EkfCovariance::Identity(n, n);
  root.matrixL().solveInPlace(solved);
  inverse->setZero(n, n);
  inverse->selfadjointView<Eigen::Lower>().rankUpdate(solved.transpose());
  inverse->triangularView<Eigen::StrictlyUpper>() = inverse->transpose();
  *inverse = scale.asDiagonal() * *inverse * scale.asDiagonal();
  return inverse->allFinite();
}

}  // namespace leonav
