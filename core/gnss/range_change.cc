#include "core/gnss/range_change.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>

#include "core/gnss/random_subset.h"

namespace leonav {
namespace {

// Unknowns, each in units of its own prior sigma: position change, position, clock, and the time
// bases' offsets from it. So every prior is the unit matrix, and a sigma of zero is no special
// case.
constexpr int kPosition = 3, kClock = 6, kTimeBase = 7;
constexpr int kUnknowns = kTimeBase + static_cast<int>(kMaxTimeBases);
using Vector = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

// Stands for no prior: far beyond any motion between two epochs, and near enough to the noise of a
// carrier for the arithmetic.
constexpr double kFree_m = 1.0e4;
// With half of the rows wrong and four unknowns one subset in sixteen is clean: all of 200 miss
// with a probability of 2e-6.
constexpr int kSubsets = 200;
constexpr int kRefits = 4;
// Sets of slips whose costs differ by less than this (chi square, 1 degree of freedom, 3 sigma)
// explain the rows equally well.
constexpr double kDecisive = 9.0;
constexpr double kMinLocalRedundancy = 0.02;

using Set = std::bitset<kMaxSatellites>;

struct Row {
  Vector h = Vector::Zero();
  double residual = 0.0;
  double sigma = 1.0;
  std::size_t source = 0;
};
using Rows = boost::container::static_vector<Row, kMaxSatellites>;
using Values = boost::container::static_vector<double, kMaxSatellites>;

struct Fit {
  Vector state = Vector::Zero();
  Matrix covariance = Matrix::Identity();
};

struct Candidate {
  Set kept;
  double cost = 0.0;
};

Eigen::Matrix3d square_root(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

bool is_usable(const RangeChangeRow& row) {
  return row.direction.allFinite() && row.direction_change.allFinite() &&
         std::isfinite(row.residual_m) && std::isfinite(row.sigma_m) && row.sigma_m > 0.0 &&
         row.time_base >= 0 && row.time_base < static_cast<int>(kMaxTimeBases);
}

class Check {
 public:
  Check(std::span<const RangeChangeRow> rows, const RangeChangePrior& prior,
        const CycleSlipConfig& config);
  RangeChangeResult run(std::size_t count);

 private:
  Fit fit(const Set& kept, double scale, bool with_covariance) const;
  double deviation(const Row& row, const Fit& fit) const {
    return row.residual - row.h.dot(fit.state);
  }
  // Of the row's deviation from what the others say, in sigma.
  struct External {
    double value_m = 0.0, sigma_m = 0.0;  // sigma 0: nothing checks it
    double standardized() const { return sigma_m > 0.0 ? std::abs(value_m) / sigma_m : 0.0; }
  };
  External external(std::size_t i, const Fit& fit, bool kept, double scale) const;
  double parameters(const Set& kept, const Fit& fit, double scale) const;
  double cost(const Set& kept, const Fit& fit, double scale) const;
  double scatter(const Vector& state) const;
  Set nearest_half(const Vector& state) const;
  Candidate converge(Set kept, double scale) const;
  Set all() const;
  void search();
  void judge(RangeChangeResult* result);

  const CycleSlipConfig& config_;
  Eigen::Matrix3d change_root_ = Eigen::Matrix3d::Zero();
  Rows rows_;
  double centre_m_ = 0.0;
  std::size_t subset_ = 1;
  double scale_ = 1.0;
  Set kept_;
  Set doubtful_;  // slipped in some explanations and not in others
  bool decided_ = true;
};

Check::Check(std::span<const RangeChangeRow> rows, const RangeChangePrior& prior,
             const CycleSlipConfig& config)
    : config_(config) {
  const bool free = prior.change_is_free || !prior.change_covariance.allFinite();
  change_root_ = free ? Eigen::Matrix3d(kFree_m * Eigen::Matrix3d::Identity())
                      : square_root(prior.change_covariance);
  const Eigen::Matrix3d position_root = prior.position_covariance.allFinite()
                                            ? square_root(prior.position_covariance)
                                            : Eigen::Matrix3d::Zero();
  Values residuals;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!is_usable(rows[i])) continue;
    Row row;
    row.h.head<3>() = change_root_.transpose() * rows[i].direction;
    row.h.segment<3>(kPosition) = position_root.transpose() * rows[i].direction_change;
    row.h(kClock) = kFree_m;
    row.h(kTimeBase + rows[i].time_base) = config.inter_system_m;
    row.residual = rows[i].residual_m;
    row.sigma = rows[i].sigma_m;
    row.source = i;
    rows_.push_back(row);
    residuals.push_back(row.residual);
  }
  if (rows_.empty()) return;
  // A clock jump is a million times a carrier's noise: taken out before anything is squared.
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  centre_m_ = *middle;
  for (Row& row : rows_) row.residual -= centre_m_;
}

Set Check::all() const {
  Set set;
  for (std::size_t i = 0; i < rows_.size(); ++i) set.set(i);
  return set;
}

Fit Check::fit(const Set& kept, double scale, bool with_covariance) const {
  Matrix normal = Matrix::Identity();
  Vector right = Vector::Zero();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!kept.test(i)) continue;
    const Row& row = rows_[i];
    const double weight = 1.0 / (row.sigma * row.sigma * scale * scale);
    const Vector weighted = weight * row.h;
    normal.noalias() += weighted * row.h.transpose();
    right += row.residual * weighted;
  }
  const Eigen::LDLT<Matrix> factor(normal);
  Fit fit;
  fit.state = factor.solve(right);
  if (with_covariance) fit.covariance = factor.solve(Matrix::Identity());
  return fit;
}

Check::External Check::external(std::size_t i, const Fit& fit, bool kept, double scale) const {
  const Row& row = rows_[i];
  const double variance = row.sigma * row.sigma * scale * scale;
  const double predicted = row.h.dot(fit.covariance * row.h);
  const double value = deviation(row, fit);
  if (!kept) return {value, std::sqrt(variance + predicted)};
  const double free = 1.0 - predicted / variance;  // local redundancy
  if (free < kMinLocalRedundancy) return {};
  return {value / free, std::sqrt(variance / free)};
}

// Unknowns that the rows, not their priors, determine.
double Check::parameters(const Set& kept, const Fit& fit, double scale) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!kept.test(i)) continue;
    const Row& row = rows_[i];
    sum += row.h.dot(fit.covariance * row.h) / (row.sigma * row.sigma * scale * scale);
  }
  return sum;
}

double Check::cost(const Set& kept, const Fit& fit, double scale) const {
  double sum = fit.state.squaredNorm();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double w = deviation(rows_[i], fit) / (rows_[i].sigma * scale);
    sum += kept.test(i) ? w * w : config_.range_change_limit * config_.range_change_limit;
  }
  return sum;
}

// 1.4826 times the median of |deviation| / sigma, of as many fewer as the subset's fit makes
// vanish.
double Check::scatter(const Vector& state) const {
  Values values;
  for (const Row& row : rows_) {
    values.push_back(std::abs(row.residual - row.h.dot(state)) / row.sigma);
  }
  const std::size_t place = std::min((values.size() + subset_) / 2, values.size() - 1);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), middle, values.end());
  return 1.4826 * *middle;
}

Set Check::nearest_half(const Vector& state) const {
  Values values, sorted;
  for (const Row& row : rows_) {
    values.push_back(std::abs(row.residual - row.h.dot(state)) / row.sigma);
  }
  sorted = values;
  const std::size_t half = std::min((values.size() + subset_ + 1) / 2, values.size()) - 1;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(half),
                   sorted.end());
  Set kept;
  for (std::size_t i = 0; i < values.size(); ++i) kept.set(i, values[i] <= sorted[half]);
  return kept;
}

// Alternates between fitting the rows kept and keeping the rows that agree with the fit.
Candidate Check::converge(Set kept, double scale) const {
  Fit best;
  for (int i = 0; i < kRefits; ++i) {
    best = fit(kept, scale, true);
    Set next;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      const External seen = external(row, best, kept.test(row), scale);
      next.set(row, seen.standardized() <= config_.range_change_limit);
    }
    if (next == kept) break;
    kept = next;
  }
  return {kept, cost(kept, fit(kept, scale, false), scale)};
}

// Fills kept_, doubtful_, scale_ and decided_.
void Check::search() {
  RandomSubset draw;
  std::array<Set, kSubsets> starts;
  double scale = config_.max_scale;
  for (Set& start : starts) {
    Set subset;
    draw.choose(rows_.size(), subset_, &subset);
    start = nearest_half(fit(subset, 1.0, false).state);
    const Fit improved = fit(start, 1.0, false);
    const double seen = scatter(improved.state);
    if (seen < scale) scale = seen;
  }
  scale_ = std::max(1.0, scale);
  std::array<Candidate, kSubsets> candidates;
  const Candidate* best = &candidates[0];
  for (int i = 0; i < kSubsets; ++i) {
    Candidate& candidate = candidates[static_cast<std::size_t>(i)];
    candidate = converge(starts[static_cast<std::size_t>(i)], scale_);
    if (candidate.cost < best->cost) best = &candidate;
  }
  kept_ = best->kept;
  const double allowance =
      static_cast<double>(kept_.count()) - parameters(kept_, fit(kept_, scale_, true), scale_);
  const double slipped = static_cast<double>((all() & ~kept_).count());
  decided_ = allowance > 0.75 && allowance > slipped - 0.25;
  for (const Candidate& candidate : candidates) {
    if (candidate.cost < best->cost + kDecisive) doubtful_ |= candidate.kept ^ kept_;
  }
}

void Check::judge(RangeChangeResult* result) {
  const Fit final_fit = fit(kept_, scale_, true);
  result->change_m = change_root_ * final_fit.state.head<3>();
  result->clock_change_m = centre_m_ + kFree_m * final_fit.state(kClock);
  result->scale = scale_;
  result->redundancy = static_cast<int>(
      std::lround(static_cast<double>(kept_.count()) - parameters(kept_, final_fit, scale_)));
  result->status = RangeChangeStatus::kConsistent;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    RangeVerdict& verdict = result->rows[rows_[i].source].verdict;
    const External seen = external(i, final_fit, kept_.test(i), scale_);
    result->rows[rows_[i].source].deviation_m = seen.value_m;
    const double size = std::abs(seen.value_m);
    if (!decided_ || doubtful_.test(i)) {
      verdict = RangeVerdict::kUndecided;
      result->status = RangeChangeStatus::kUndecidable;
    } else if (seen.sigma_m == 0.0) {
      verdict = RangeVerdict::kNotTested;
    } else if (seen.standardized() > config_.range_change_limit &&
               size > config_.range_change_min_m) {
      verdict = RangeVerdict::kSlipped;
      if (result->status == RangeChangeStatus::kConsistent) {
        result->status = RangeChangeStatus::kSlips;
      }
    } else if (seen.standardized() > config_.range_change_clear) {
      verdict = RangeVerdict::kUndecided;
    } else if (config_.range_change_limit * seen.sigma_m <= config_.range_change_power_m) {
      verdict = RangeVerdict::kConsistent;
    }
  }
}

RangeChangeResult Check::run(std::size_t count) {
  RangeChangeResult result;
  result.rows.resize(count);
  if (rows_.size() < 2) return result;
  kept_ = all();
  const Fit plain = fit(kept_, 1.0, true);
  const double unknowns = parameters(kept_, plain, 1.0);
  const double spare = static_cast<double>(rows_.size()) - unknowns;
  if (spare < 0.5) return result;
  double worst = 0.0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    worst = std::max(worst, external(i, plain, true, 1.0).standardized());
  }
  if (worst > config_.range_change_clear) {
    subset_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(unknowns)), 1,
                                      rows_.size() - 1);
    search();
  }
  judge(&result);
  return result;
}

}  // namespace

RangeChangeResult range_change(std::span<const RangeChangeRow> rows, const RangeChangePrior& prior,
                               const CycleSlipConfig& config) {
  const std::size_t count = std::min(rows.size(), kMaxSatellites);
  return Check(rows.first(count), prior, config).run(count);
}

}  // namespace leonav
