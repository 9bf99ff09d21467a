#include "core/robust/internal/consensus.h"

#include <Eigen/Core>
#include <cstdio>
#include <random>

#include "support/catch.h"
#include "support/dense/dense_algebra.h"

namespace leonav::test {

// The scale decides what is out and how large the covariance is: it must not grow with the share
// of unknowns.
TEST_CASE("scale of the residuals of a least-squares fit is that of the errors") {
  std::mt19937 generator(11);
  std::normal_distribution<double> normal;
  for (const int rows : {9, 10, 13, 20, 40}) {
    constexpr int kUnknowns = 5, kRuns = 4000;
    constexpr double kScale = 2.0;
    double sum = 0.0;
    for (int run = 0; run < kRuns; ++run) {
      const Eigen::MatrixXd design =
          Eigen::MatrixXd::NullaryExpr(rows, kUnknowns, [&] { return normal(generator); });
      const Eigen::VectorXd errors =
          Eigen::VectorXd::NullaryExpr(rows, [&] { return kScale * normal(generator); });
      const Eigen::VectorXd residuals =
          errors - design * dense::least_squares(design, errors).solution;
      StandardizedResiduals standardized;
      for (const double residual : residuals) standardized.push_back(std::abs(residual));
      sum += robust_scale(&standardized, kUnknowns) / kRuns;
    }
    std::printf("%2d rows, %d unknowns: mean scale %.3f of %.1f\n", rows, kUnknowns, sum, kScale);
    CHECK(sum == Approx(kScale).epsilon(0.05));
  }
}

}  // namespace leonav::test
