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
// with a probability of 2e-6. Fewer do where fewer rows are wrong, but so many that other
// explanations are met too.
constexpr std::size_t kSubsets = 200, kFewestSubsets = 48;
constexpr double kAllMiss = 2e-6;
constexpr int kRefits = 4;
constexpr double kWidening = 1.25;  // of the sigmas, by step
// Sets of slips whose costs differ by less than this (chi square, 1 degree of freedom, 3 sigma)
// explain the rows equally well.
constexpr double kDecisive = 9.0;
constexpr double kQuarterCycle_m = 0.05;
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

using Starts = boost::container::static_vector<Set, kSubsets>;
using Candidates = boost::container::static_vector<Candidate, kSubsets>;
struct Visit {
  Set kept;
  std::size_t start = 0;  // whose way came through it
};
using Visits = boost::container::static_vector<Visit, kSubsets * kRefits>;

Eigen::Matrix3d square_root(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

bool is_usable(const RangeChangeRow& row) {
  return row.direction.allFinite() && row.direction_change.allFinite() &&
         std::isfinite(row.residual_m) && std::isfinite(row.sigma_m) && row.sigma_m > 0.0 &&
         row.time_base >= 0 && row.time_base < static_cast<int>(kMaxTimeBases);
}

Matrix row_information(const Row& row) {
  const double sigma = std::max(row.sigma, kQuarterCycle_m);
  return row.h * row.h.transpose() / (sigma * sigma);
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
  double parameters(const Set& kept) const;
  double cost(const Set& kept, const Fit& fit, double scale) const;
  Set nearest_half(const Vector& state) const;
  Set agreeing(const Set& kept) const;
  Set all() const;
  bool enough(std::size_t drawn, const Set& best) const;
  Candidate converge(Set kept, const Candidates& before, Visits* visits) const;
  void draw(Starts* starts, Candidates* candidates) const;
  double scatter(const Set& kept) const;
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

// Unknowns that the rows, not their priors, determine, where what matters is a cycle: a prior of
// centimetres leaves nothing to determine.
double Check::parameters(const Set& kept) const {
  Matrix normal = Matrix::Identity();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (kept.test(i)) normal += row_information(rows_[i]);
  }
  const Matrix covariance = Eigen::LDLT<Matrix>(normal).solve(Matrix::Identity());
  return static_cast<double>(kUnknowns) - covariance.trace();
}

double Check::cost(const Set& kept, const Fit& fit, double scale) const {
  double sum = fit.state.squaredNorm();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double w = deviation(rows_[i], fit) / (rows_[i].sigma * scale);
    sum += kept.test(i) ? w * w : config_.range_change_limit * config_.range_change_limit;
  }
  return sum;
}

Set Check::nearest_half(const Vector& state) const {
  Values values, sorted;
  for (const Row& row : rows_) {
    values.push_back(std::abs(row.residual - row.h.dot(state)) / row.sigma);
  }
  sorted = values;
  const std::size_t half = std::min((values.size() + subset_ + 1) / 2, values.size() - 1) - 1;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(half),
                   sorted.end());
  Set kept;
  for (std::size_t i = 0; i < values.size(); ++i) kept.set(i, values[i] <= sorted[half]);
  return kept;
}

// The rows that agree with a fit of the rows kept.
Set Check::agreeing(const Set& kept) const {
  const Fit of_kept = fit(kept, scale_, true);
  Set next;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const External seen = external(row, of_kept, kept.test(row), scale_);
    next.set(row, seen.standardized() <= config_.range_change_limit);
  }
  return next;
}

// Alternates between fitting the rows kept and keeping the rows that agree with the fit. Most
// starts soon meet the way of one `before`, and end where that ended.
Candidate Check::converge(Set kept, const Candidates& before, Visits* visits) const {
  const std::size_t start = before.size();
  for (int refit = 0; refit < kRefits; ++refit) {
    const auto visit = std::find_if(visits->begin(), visits->end(),
                                    [&](const Visit& v) { return v.kept == kept; });
    if (visit != visits->end()) {
      if (visit->start != start) return before[visit->start];
      break;
    }
    visits->push_back({kept, start});
    kept = agreeing(kept);
  }
  return {kept, cost(kept, fit(kept, scale_, false), scale_)};
}

// Whether so many subsets make sure of a clean one, if `best` are the clean rows.
bool Check::enough(std::size_t drawn, const Set& best) const {
  if (drawn < kFewestSubsets) return false;
  const double share = static_cast<double>(best.count()) / static_cast<double>(rows_.size());
  const double clean = std::pow(share, static_cast<double>(subset_));
  return std::pow(1.0 - clean, static_cast<double>(drawn)) < kAllMiss;
}

const Candidate& best_of(const Candidates& candidates) {
  return *std::min_element(candidates.begin(), candidates.end(),
                           [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
}

// Starts: the half of the rows nearest to a fit through few, for many drawn few.
void Check::draw(Starts* starts, Candidates* candidates) const {
  RandomSubset subsets;
  Visits visits;
  while (starts->size() < kSubsets) {
    Set subset;
    subsets.choose(rows_.size(), subset_, &subset);
    starts->push_back(nearest_half(fit(subset, 1.0, false).state));
    candidates->push_back(converge(starts->back(), *candidates, &visits));
    if (enough(starts->size(), best_of(*candidates).kept)) return;
  }
}

// Fills kept_, doubtful_, scale_ and decided_. The sigmas are widened only where the rows that
// agree best scatter by more than they say: a median over all rows would be that of slips as well.
void Check::search() {
  Starts starts;
  Candidates candidates;
  draw(&starts, &candidates);
  while (scale_ < config_.max_scale && scatter(best_of(candidates).kept) > kWidening * scale_) {
    scale_ = std::min(kWidening * scale_, config_.max_scale);
    Visits visits;
    candidates.clear();
    for (const Set& start : starts) candidates.push_back(converge(start, candidates, &visits));
  }
  const Candidate& best = best_of(candidates);
  kept_ = best.kept;
  const double allowance = static_cast<double>(kept_.count()) - parameters(kept_);
  const double slipped = static_cast<double>((all() & ~kept_).count());
  decided_ = allowance > 0.75 && allowance > slipped - 0.25;
  for (const Candidate& candidate : candidates) {
    if (candidate.cost < best.cost + kDecisive) doubtful_ |= candidate.kept ^ kept_;
  }
}

// Root mean square of the kept rows' deviations over their sigmas; 0 where too few are spare.
double Check::scatter(const Set& kept) const {
  const double spare = static_cast<double>(kept.count()) - parameters(kept);
  if (spare < 2.0) return 0.0;
  const Vector state = fit(kept, scale_, false).state;
  double sum = 0.0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!kept.test(i)) continue;
    const double w = (rows_[i].residual - rows_[i].h.dot(state)) / rows_[i].sigma;
    sum += w * w;
  }
  return std::sqrt(sum / spare);
}

void Check::judge(RangeChangeResult* result) {
  const Fit final_fit = fit(kept_, scale_, true);
  result->change_m = change_root_ * final_fit.state.head<3>();
  result->clock_change_m = centre_m_ + kFree_m * final_fit.state(kClock);
  result->scale = scale_;
  result->redundancy =
      static_cast<int>(std::lround(static_cast<double>(kept_.count()) - parameters(kept_)));
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
  const double unknowns = parameters(kept_);
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
