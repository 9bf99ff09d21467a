// Dense linear algebra of the tests' oracles: Eigen's general decompositions, compiled once,
// because every program that instantiates them takes long to compile.
#pragma once
#include <Eigen/Core>

namespace leonav::dense {

// M^-1 by LU with partial pivoting; `M` is square and not singular.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& M);

// x of M x = b by LDL^T; `M` is symmetric and positive definite.
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& M, const Eigen::VectorXd& b);

// error^T P^-1 error, the normalized estimation error squared (Bar-Shalom, Li, Kirubarajan
// 2001, 5.4.2); `P` of the error's size.
double nees(const Eigen::VectorXd& error, const Eigen::MatrixXd& P);

// x of least |J x - r| by Householder QR, columns scaled to one, and (J^T J)^-1; `J` of full column
// rank.
struct LeastSquares {
  Eigen::VectorXd solution;
  Eigen::MatrixXd covariance;
};
LeastSquares least_squares(const Eigen::MatrixXd& J, const Eigen::VectorXd& r);

// x of least |J x - r|, of these the shortest, by a complete orthogonal decomposition, and the rank
// of `J`.
struct ShortestFit {
  Eigen::VectorXd solution;
  Eigen::Index rank = 0;
};
ShortestFit shortest_fit(const Eigen::MatrixXd& J, const Eigen::VectorXd& r);

// Eigenvalues of a symmetric matrix, ascending, and its eigenvectors as columns of length one.
struct SymmetricParts {
  Eigen::VectorXd eigenvalues;
  Eigen::MatrixXd eigenvectors;
};
SymmetricParts symmetric_parts(const Eigen::MatrixXd& M);

// W with W covariance W^T = 1, by Cholesky's root. A variance of nothing becomes one too small to
// tell, 1e-14.
Eigen::MatrixXd whitening(Eigen::MatrixXd covariance);

}  // namespace leonav::dense
