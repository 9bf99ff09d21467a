#include "core/ekf/robust_update.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/ekf/median.h"

namespace leonav {
namespace {

using ekf_index::kSize;
using SmallTable = boost::container::static_vector<double, kMaxMeasurements>;

constexpr double kFactorTolerance = 1e-3;  // weights that change less have converged
constexpr double kNormalMedian = 0.6745;   // median of |x| for a standard normal x
constexpr double kMaxPriorScale = 2.0;  // innovations may be this much larger than they should be
constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr std::size_t kMinScaleCount = 5;  // fewer residuals do not tell their scale

// Lower L with P = L L^T for a positive semidefinite P; a state without variance gets a zero
// column.
EkfCovariance semidefinite_cholesky(const EkfCovariance& P) {
  EkfCovariance L = EkfCovariance::Zero();
  for (int j = 0; j < kSize; ++j) {
    if (P(j, j) <= 0.0) continue;
    const double pivot = P(j, j) - L.row(j).head(j).squaredNorm();
    // Rounding may eat a pivot of a nearly perfect correlation: it keeps a trace of its variance.
    const double root = std::sqrt(std::max(pivot, 1e-14 * P(j, j)));
    L(j, j) = root;
    for (int i = j + 1; i < kSize; ++i)
      L(i, j) = (P(i, j) - L.row(i).head(j).dot(L.row(j).head(j))) / root;
  }
  return L;
}

// The weighted problem in the coordinates z = L^-1 x, where the prior is the identity.
struct Whitened {
  EkfCovariance L;
  Eigen::Matrix<double, kSize, Eigen::Dynamic, Eigen::ColMajor, kSize, kMaxMeasurements> rows;
  EkfCovariance information = EkfCovariance::Identity();
  Eigen::LLT<EkfCovariance> root;
  EkfVector solution = EkfVector::Zero();
  EkfVector gradient = EkfVector::Zero();
};

void solve(const FilterMeasurements& measurements, Whitened* problem) {
  problem->information.setIdentity();
  problem->gradient.setZero();
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const FilterMeasurement& measurement = measurements[i];
    if (measurement.factor <= 0.0) continue;
    const double weight = measurement.factor / measurement.gain_variance;
    const auto g = problem->rows.col(static_cast<Eigen::Index>(i));
    problem->information.selfadjointView<Eigen::Lower>().rankUpdate(g, weight);
    problem->gradient += weight * measurement.innovation * g;
  }
  problem->root.compute(problem->information);
  problem->solution = problem->root.solve(problem->gradient);
}

// |residual against all others| over its standard deviation, per measurement.
void standardize(const FilterMeasurements& measurements, const Whitened& problem,
                 SmallTable* ratios) {
  ratios->clear();
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const FilterMeasurement& measurement = measurements[i];
    EkfVector g = problem.rows.col(static_cast<Eigen::Index>(i));
    const double residual = measurement.innovation - g.dot(problem.solution);
    problem.root.matrixL().solveInPlace(g);
    const double variance = g.squaredNorm();  // of the prediction, this measurement included
    const double weight = measurement.factor / measurement.gain_variance;
    const double freedom = std::max(1.0 - weight * variance, 1e-12);
    const double sigma = std::sqrt(measurement.variance + variance / freedom);
    ratios->push_back(std::abs(residual) / freedom / sigma);
  }
}

double scale_of(const FilterMeasurements& measurements, const SmallTable& ratios,
                Observable observable) {
  SmallTable of_kind;
  for (std::size_t i = 0; i < measurements.size(); ++i)
    if (measurements[i].observable == observable) of_kind.push_back(ratios[i]);
  if (of_kind.size() < kMinScaleCount) return 1.0;
  return std::max(1.0, median(of_kind) / kNormalMedian);
}

// Returns the largest change of a factor. `limits` are the factors that the prior allows: what it
// excludes, no number of others can bring back.
double reweight(const RobustConfig& config, const SmallTable& ratios, double max_scale,
                const SmallTable& limits, FilterMeasurements* measurements,
                RobustUpdateResult* result) {
  result->code_scale = scale_of(*measurements, ratios, Observable::kCode);
  result->doppler_scale = scale_of(*measurements, ratios, Observable::kDoppler);
  double change = 0.0;
  for (std::size_t i = 0; i < measurements->size(); ++i) {
    FilterMeasurement& measurement = (*measurements)[i];
    const bool code = measurement.observable == Observable::kCode;
    const double scale = std::min(max_scale, code ? result->code_scale : result->doppler_scale);
    const double factor = std::min(limits[i], igg3_factor(ratios[i] / scale, config.k0, config.k1));
    change = std::max(change, std::abs(factor - measurement.factor));
    measurement.factor = factor;
  }
  return change;
}

}  // namespace

RobustUpdateResult robust_update(const RobustConfig& config, FilterMeasurements* measurements,
                                 EkfCovariance* covariance) {
  RobustUpdateResult result;
  if (measurements->empty()) return result;

  Whitened problem;
  problem.L = semidefinite_cholesky(*covariance);
  problem.rows.resize(kSize, static_cast<Eigen::Index>(measurements->size()));
  for (std::size_t i = 0; i < measurements->size(); ++i)
    problem.rows.col(static_cast<Eigen::Index>(i)).noalias() =
        problem.L.transpose() * (*measurements)[i].row;

  if (config.enabled) {
    for (FilterMeasurement& measurement : *measurements) measurement.factor = 0.0;
    solve(*measurements, &problem);
    SmallTable ratios;
    SmallTable limits(measurements->size(), 1.0);
    for (int pass = 0; pass < std::max(config.max_iterations, 1); ++pass) {
      const bool first = pass == 0;  // nothing used yet: innovations
      standardize(*measurements, problem, &ratios);
      const double change = reweight(config, ratios, first ? kMaxPriorScale : kUnlimited, limits,
                                     measurements, &result);
      if (first) {
        for (std::size_t i = 0; i < limits.size(); ++i)
          limits[i] = (*measurements)[i].factor > 0.0 ? 1.0 : 0.0;
      }
      solve(*measurements, &problem);
      if (change < kFactorTolerance) break;
    }
  } else {
    for (FilterMeasurement& measurement : *measurements) measurement.factor = 1.0;
    solve(*measurements, &problem);
  }

  result.correction = problem.L * problem.solution;
  for (const FilterMeasurement& measurement : *measurements)
    result.nis += measurement.factor / measurement.gain_variance * measurement.innovation *
                  measurement.innovation;
  result.nis -= problem.gradient.dot(problem.solution);
  // W = L U^-T with U U^T the information; P+ = W W^T.
  const EkfCovariance W_transposed = problem.root.matrixL().solve(problem.L.transpose());
  covariance->noalias() = W_transposed.transpose() * W_transposed;
  return result;
}

}  // namespace leonav
