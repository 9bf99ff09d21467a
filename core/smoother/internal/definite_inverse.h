// This unit inverts a covariance matrix of states with very different units.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace leonav {

// Inverts a positive definite matrix whose diagonal may span many orders of magnitude. Returns
// false if it is not positive definite. `Matrix` has its own storage; one of fixed capacity
// allocates nothing. `Inverse` is a `Matrix`, or a map of one that has the right size.
template <typename Matrix, typename Inverse>
bool invert(const Matrix& matrix, Inverse* inverse) {
  using Vector =
      Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1, 0, Matrix::MaxRowsAtCompileTime, 1>;
  const Eigen::Index n = matrix.rows();
  const Vector scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return false;
  const Matrix scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::LLT<Matrix> root(scaled);
  if (root.info() != Eigen::Success) return false;
  Matrix solved = Matrix::Identity(n, n);
  root.matrixL().solveInPlace(solved);
  inverse->resize(n, n);
  inverse->setZero();
  inverse->template selfadjointView<Eigen::Lower>().rankUpdate(solved.transpose());
  inverse->template triangularView<Eigen::StrictlyUpper>() = inverse->transpose();
  *inverse = scale.asDiagonal() * *inverse * scale.asDiagonal();
  return inverse->allFinite();
}

}  // namespace leonav
