#include "support/dense/dense_algebra.h"

#include <Eigen/Dense>
#include <algorithm>

namespace leonav::dense {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd inverse(const MatrixXd& M) { return M.inverse(); }

VectorXd solve_symmetric(const MatrixXd& M, const VectorXd& b) { return M.ldlt().solve(b); }

double nees(const VectorXd& error, const MatrixXd& P) {
  return error.dot(solve_symmetric(P, error));
}

LeastSquares least_squares(const MatrixXd& J, const VectorXd& r) {
  const VectorXd scale = J.colwise().norm().cwiseInverse();
  const Eigen::HouseholderQR<MatrixXd> qr(J * scale.asDiagonal());
  MatrixXd root = MatrixXd::Identity(J.cols(), J.cols());
  qr.matrixQR().topRows(J.cols()).triangularView<Eigen::Upper>().solveInPlace(root);
  root = scale.asDiagonal() * root;
  return {scale.asDiagonal() * VectorXd(qr.solve(r)), root * root.transpose()};
}

ShortestFit shortest_fit(const MatrixXd& J, const VectorXd& r) {
  const Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition(J);
  return {decomposition.solve(r), decomposition.rank()};
}

SymmetricParts symmetric_parts(const MatrixXd& M) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> parts(M);
  return {parts.eigenvalues(), parts.eigenvectors()};
}

MatrixXd whitening(MatrixXd covariance) {
  constexpr double kNothing = 1e-14;
  for (double& variance : covariance.diagonal()) variance = std::max(variance, kNothing);
  const VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const MatrixXd scaled = scale.asDiagonal() * covariance * scale.asDiagonal();
  MatrixXd root = MatrixXd::Identity(scaled.rows(), scaled.cols());
  Eigen::LLT<MatrixXd>(scaled).matrixL().solveInPlace(root);
  return root * scale.asDiagonal();
}

}  // namespace leonav::dense
