#include "core/ekf/robust_update.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/median.h"

namespace leonav {
namespace {

using ekf_index::kMaxSize;
using ekf_index::kSize;
using SmallTable = boost::container::static_vector<double, kMaxMeasurements>;

constexpr double kFactorTolerance = 1e-3;  // weights that change less have converged
constexpr double kUnsettled = 0.5;         // ... and more than this have not
constexpr int kMaxRounds = 20;             // of throwing out the worst
constexpr double kNearWorst = 0.7;         // of the worst: go with it
constexpr double kNormalMedian = 0.6745;   // median of |x| for a standard normal x
constexpr double kMaxPriorScale = 2.0;  // innovations may be this much larger than they should be
constexpr double kUnlimited = std::numeric_limits<double>::infinity();
// Residuals that are this much larger, the worst of them left out, are of measurements that
// contradict each other.
constexpr double kMaxScale = 3.0;
constexpr std::size_t kMinScaleCount = 5;  // fewer residuals do not tell their scale

// Lower L with P = L L^T for a positive semidefinite P; a state without variance gets a zero
// column.
void semidefinite_cholesky(const EkfCovariance& P, EkfCovariance* root) {
  const Eigen::Index n = P.rows();
  EkfCovariance& L = *root;
  L.setZero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    if (P(j, j) <= 0.0) continue;
    const Eigen::Index below = n - j;
    auto column = L.col(j).tail(below);
    column = P.col(j).tail(below);
    column.noalias() -= L.block(j, 0, below, j) * L.row(j).head(j).transpose();
    // Rounding may eat a pivot of a nearly perfect correlation: it keeps a trace of its variance.
    const double pivot = std::sqrt(std::max(column(0), 1e-14 * P(j, j)));
    column(0) = pivot;
    column.tail(below - 1) /= pivot;
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

// Measurements that contradict each other get the variance that their residuals show. Carriers do
// not: those have slipped. False if there are none.
bool relax(const std::array<double, kObservables>& scale, FilterMeasurements* measurements) {
  bool any = false;
  for (FilterMeasurement& measurement : *measurements) {
    const double of_kind = scale[static_cast<std::size_t>(measurement.observable)];
    if (measurement.observable == Observable::kCarrier || of_kind <= kMaxScale) continue;
    measurement.variance *= of_kind * of_kind;
    measurement.gain_variance *= of_kind * of_kind;
    any = true;
  }
  return any;
}

// Where ranges contradict each other a few carriers that happen to agree, as four always do about
// one position, must not decide by their millimetres: without most of them on their side none
// counts.
// False: most are.
template <typename Limits>
bool leave_out_few_carriers(const FilterMeasurements& measurements, Limits* limits) {
  std::size_t offered = 0, kept = 0;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.observable != Observable::kCarrier) continue;
    ++offered;
    kept += measurement.factor > 0.0 ? 1 : 0;
  }
  if (4 * kept >= 3 * offered) return false;
  for (std::size_t i = 0; i < limits->size(); ++i)
    if (measurements[i].observable == Observable::kCarrier) (*limits)[i] = 0.0;
  return true;
}

// By how much an observable's residuals may be larger than they should be. Carriers that fit no
// better than this have slipped, however many they are.
double scale_limit(const FilterMeasurement& measurement, const RobustUpdateResult& weighed) {
  const double scale = weighed.scale[static_cast<std::size_t>(measurement.observable)];
  return measurement.observable == Observable::kCarrier ? std::min(scale, kMaxPriorScale) : scale;
}

// Returns the largest change of a factor. `limits` are the factors that the prior allows: what it
// excludes, no number of others can bring back.
double reweight(const RobustConfig& config, const SmallTable& ratios, double max_scale,
                const SmallTable& limits, FilterMeasurements* measurements,
                RobustUpdateResult* result) {
  for (std::size_t kind = 0; kind < kObservables; ++kind)
    result->scale[kind] = scale_of(*measurements, ratios, static_cast<Observable>(kind));
  double change = 0.0;
  for (std::size_t i = 0; i < measurements->size(); ++i) {
    FilterMeasurement& measurement = (*measurements)[i];
    // Carriers that fit no better than this have slipped, however many they are.
    const double limit =
        measurement.observable == Observable::kCarrier ? kMaxPriorScale : max_scale;
    const double scale =
        std::min(limit, result->scale[static_cast<std::size_t>(measurement.observable)]);
    const double factor = std::min(limits[i], igg3_factor(ratios[i] / scale, config.k0, config.k1));
    change = std::max(change, std::abs(factor - measurement.factor));
    measurement.factor = factor;
  }
  return change;
}

}  // namespace

double predicted_variance(const FilterMeasurement& measurement, const EkfCovariance& covariance) {
  const auto core = covariance.topLeftCorner<kSize, kSize>();
  double variance = measurement.row.dot(core * measurement.row);
  if (measurement.ambiguity >= 0) {
    variance += 2.0 * covariance.col(measurement.ambiguity).head<kSize>().dot(measurement.row) +
                covariance(measurement.ambiguity, measurement.ambiguity);
  }
  return variance;
}

// The weighted problem in the coordinates z = L^-1 x, where the prior is the identity.
struct RobustUpdate::Workspace {
  static constexpr int kTable = kMaxSize * static_cast<int>(kMaxMeasurements);
  using Rows = Eigen::Map<Eigen::Matrix<double, kMaxSize, static_cast<int>(kMaxMeasurements)>>;

  EkfCovariance L;
  EkfCovariance information;
  Eigen::LLT<EkfCovariance, Eigen::Lower> root;
  EkfCorrection solution, gradient;
  // A column per measurement: its row times L, the same weighted, the same solved by the root.
  std::unique_ptr<double[]> storage = std::make_unique<double[]>(2 * kTable);
  Rows rows{storage.get()}, weighted{storage.get() + kTable};
  Eigen::Index states = 0, count = 0;

  void begin(const FilterMeasurements& measurements, const EkfCovariance& covariance) {
    states = covariance.rows();
    count = static_cast<Eigen::Index>(measurements.size());
    semidefinite_cholesky(covariance, &L);
    for (Eigen::Index i = 0; i < count; ++i) {
      const FilterMeasurement& measurement = measurements[static_cast<std::size_t>(i)];
      auto g = rows.col(i).head(states);
      g.noalias() = L.topRows<kSize>().transpose() * measurement.row;
      if (measurement.ambiguity >= 0) g += L.row(measurement.ambiguity).transpose();
    }
  }

  void solve(const FilterMeasurements& measurements) {
    information.setIdentity(states, states);
    gradient.setZero(states);
    Eigen::Index used = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
      const FilterMeasurement& measurement = measurements[static_cast<std::size_t>(i)];
      if (measurement.factor <= 0.0) continue;
      const double weight = measurement.factor / measurement.gain_variance;
      const auto g = rows.col(i).head(states);
      weighted.col(used++).head(states) = std::sqrt(weight) * g;
      gradient += weight * measurement.innovation * g;
    }
    if (used > 0)
      information.selfadjointView<Eigen::Lower>().rankUpdate(weighted.topLeftCorner(states, used));
    root.compute(information);
    solution = gradient;
    root.solveInPlace(solution);
  }

  // |residual against all others| over its standard deviation, per measurement.
  void standardize(const FilterMeasurements& measurements, SmallTable* ratios) {
    auto solved = weighted.topLeftCorner(states, count);
    solved = rows.topLeftCorner(states, count);
    root.matrixL().solveInPlace(solved);
    ratios->clear();
    for (Eigen::Index i = 0; i < count; ++i) {
      const FilterMeasurement& measurement = measurements[static_cast<std::size_t>(i)];
      const double residual = measurement.innovation - rows.col(i).head(states).dot(solution);
      const double variance = solved.col(i).squaredNorm();  // of the prediction, this one included
      const double weight = measurement.factor / measurement.gain_variance;
      const double freedom = std::max(1.0 - weight * variance, 1e-12);
      const double sigma = std::sqrt(measurement.variance + variance / freedom);
      ratios->push_back(std::abs(residual) / freedom / sigma);
    }
  }
};

RobustUpdate::RobustUpdate() : workspace_(std::make_unique<Workspace>()) {}
RobustUpdate::~RobustUpdate() = default;
RobustUpdate::RobustUpdate(RobustUpdate&&) noexcept = default;
RobustUpdate& RobustUpdate::operator=(RobustUpdate&&) noexcept = default;

// Iterates the weights; the workspace then holds the solution. `limits`: what the prior excludes,
// 0; that of an earlier call stays out.
void RobustUpdate::weigh(const RobustConfig& config, FactorLimits* limits,
                         FilterMeasurements* measurements, RobustUpdateResult* result) {
  Workspace& problem = *workspace_;
  for (FilterMeasurement& measurement : *measurements) measurement.factor = 0.0;
  problem.solve(*measurements);
  SmallTable ratios;
  double change = 1.0;
  for (int pass = 0; pass < std::max(config.max_iterations, 1); ++pass) {
    const bool first = pass == 0;  // nothing used yet: innovations
    problem.standardize(*measurements, &ratios);
    for (std::size_t i = 0; first && i < ratios.size(); ++i)
      ratios[i] = std::max(ratios[i], (*measurements)[i].prior_ratio);
    change = reweight(config, ratios, first ? kMaxPriorScale : kUnlimited, *limits, measurements,
                      result);
    if (first) {
      for (std::size_t i = 0; i < limits->size(); ++i)
        (*limits)[i] = (*measurements)[i].factor > 0.0 ? 1.0 : 0.0;
    }
    problem.solve(*measurements);
    if (change < kFactorTolerance) return;
  }
  if (change < kUnsettled || config.max_iterations < 3 || settled_) return;
  throw_out_worst_first(config, *result, limits, measurements);
  weigh(config, limits, measurements, result);
}

// Where many carriers contradict each other they go out together, fit the codes, come in together,
// and so on. Then the worst go one after the other, from all that the prior allows, until the rest
// agree; and carriers that only a few are left of prove nothing.
void RobustUpdate::throw_out_worst_first(const RobustConfig& config,
                                         const RobustUpdateResult& weighed, FactorLimits* limits,
                                         FilterMeasurements* measurements) {
  Workspace& problem = *workspace_;
  SmallTable ratios;
  for (std::size_t i = 0; i < limits->size(); ++i)
    if ((*measurements)[i].observable == Observable::kCarrier)
      (*measurements)[i].factor = (*limits)[i];
  for (int round = 0; round < kMaxRounds; ++round) {
    problem.solve(*measurements);
    problem.standardize(*measurements, &ratios);
    double worst = 0.0;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      FilterMeasurement& measurement = (*measurements)[i];
      ratios[i] /= scale_limit(measurement, weighed);
      if (measurement.observable != Observable::kCarrier)
        measurement.factor = std::min((*limits)[i], igg3_factor(ratios[i], config.k0, config.k1));
      else if (measurement.factor > 0.0)
        worst = std::max(worst, ratios[i]);
    }
    if (worst < config.k1) break;
    for (std::size_t i = 0; i < ratios.size(); ++i)
      if ((*measurements)[i].observable == Observable::kCarrier && ratios[i] >= kNearWorst * worst)
        (*limits)[i] = (*measurements)[i].factor = 0.0;
  }
  leave_out_few_carriers(*measurements, limits);
  settled_ = true;
}

RobustUpdateResult RobustUpdate::operator()(const RobustConfig& config,
                                            FilterMeasurements* measurements,
                                            EkfCovariance* covariance) {
  RobustUpdateResult result;
  result.correction.setZero(covariance->rows());
  if (measurements->empty()) return result;

  Workspace& problem = *workspace_;
  problem.begin(*measurements, *covariance);
  if (config.enabled) {
    FactorLimits limits(measurements->size(), 1.0);
    settled_ = false;
    weigh(config, &limits, measurements, &result);
    const auto scale = result.scale;
    if (relax(scale, measurements)) {
      settled_ = false;
      weigh(config, &limits, measurements, &result);
      if (leave_out_few_carriers(*measurements, &limits))
        weigh(config, &limits, measurements, &result);
      for (FilterMeasurement& measurement : *measurements) {
        const double of_kind = scale[static_cast<std::size_t>(measurement.observable)];
        if (measurement.observable != Observable::kCarrier && of_kind > kMaxScale) {
          // What it weighs against what it was said to be worth.
          measurement.factor /= of_kind * of_kind;
          measurement.variance /= of_kind * of_kind;
          measurement.gain_variance /= of_kind * of_kind;
        }
      }
      result.scale = scale;
    }
  } else {
    for (FilterMeasurement& measurement : *measurements) measurement.factor = 1.0;
    problem.solve(*measurements);
  }

  result.correction.noalias() = problem.L * problem.solution;
  for (const FilterMeasurement& measurement : *measurements)
    result.nis += measurement.factor / measurement.gain_variance * measurement.innovation *
                  measurement.innovation;
  result.nis -= problem.gradient.dot(problem.solution);
  // W = L U^-T with U U^T the information; P+ = W W^T.
  EkfCovariance W_transposed = problem.L.transpose();
  problem.root.matrixL().solveInPlace(W_transposed);
  covariance->setZero();
  covariance->selfadjointView<Eigen::Lower>().rankUpdate(W_transposed.transpose());
  covariance->triangularView<Eigen::StrictlyUpper>() = covariance->transpose();
  return result;
}

}  // namespace leonav
