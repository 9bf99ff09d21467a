#include "core/gnss/cycle_slips/internal/range_change_fit.h"

#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

constexpr double kQuarterCycle_m = 0.05;
constexpr double kMinLocalRedundancy = 0.02;

// Adds weight * h * h^T; only the diagonal and the part below it are used.
inline void add_square(const ChangeVector& h, double weight, int unknowns,
                       ChangeFit::Matrix* normal) {
  constexpr int kHalf = kChangeUnknowns / 2;
  static_assert(kHalf <= kChangeTimeBase);
  const ChangeVector weighted = weight * h;
  for (int a = 0; a < kHalf; ++a) normal->col(a) += h(a) * weighted;
  for (int a = kHalf; a < unknowns; ++a)
    normal->col(a).tail<kHalf>() += h(a) * weighted.tail<kHalf>();
}

}  // namespace

double ExternalDeviation::standardized() const {
  return sigma_m > 0.0 ? std::abs(value_m) / sigma_m : 0.0;
}

ChangeFitter::ChangeFitter(const ChangeRows& rows, const CycleSlipConfig& config)
    : rows_(rows), config_(config) {
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t lane = i % kLanes;
    if (lane == 0) {
      Block& block = blocks_.emplace_back();
      for (Lanes& h : block.h) h.setZero();
      block.residual.setZero();
      block.variance.setOnes();
    }
    const ChangeRow& row = rows_.rows[i];
    Block& block = blocks_.back();
    const auto at = static_cast<Eigen::Index>(lane);
    for (int a = 0; a < kChangeUnknowns; ++a) block.h[static_cast<std::size_t>(a)](at) = row.h(a);
    block.residual(at) = row.residual;
    block.variance(at) = row.sigma * row.sigma;
  }
}

ChangeSet ChangeFitter::all() const {
  ChangeSet set;
  for (std::size_t i = 0; i < size(); ++i) set.set(i);
  return set;
}

// Factorizes fit->lower, a normal matrix that contains the priors. As no prior is wider than 1, no
// pivot is smaller than 1 but by rounding.
void ChangeFitter::factorize(ChangeFit* fit) const {
  ChangeFit::Matrix& m = fit->lower;
  for (int j = 0; j < rows_.unknowns; ++j) {
    const double inverse = 1.0 / std::max(m(j, j), 1.0);
    fit->inverse_pivots(j) = inverse;
    for (int i = j + 1; i < rows_.unknowns; ++i) {
      const double factor = m(i, j) * inverse;
      for (int k = i; k < rows_.unknowns; ++k) m(k, i) -= factor * m(k, j);
    }
    for (int i = j + 1; i < rows_.unknowns; ++i) m(i, j) *= inverse;
  }
}

ChangeFit ChangeFitter::fit(const ChangeSet& kept, double scale) const {
  ChangeFit fit;
  fit.scale = scale;
  fit.lower.setIdentity();
  ChangeVector right = ChangeVector::Zero();
  for (std::size_t i = 0; i < size(); ++i) {
    if (!kept.test(i)) continue;
    const ChangeRow& row = rows_.rows[i];
    const double weight = 1.0 / (row.sigma * row.sigma * scale * scale);
    add_square(row.h, weight, rows_.unknowns, &fit.lower);
    right += (weight * row.residual) * row.h;
  }
  factorize(&fit);
  const int n = rows_.unknowns;
  for (int j = 0; j < n; ++j) {
    for (int i = j + 1; i < n; ++i) right(i) -= fit.lower(i, j) * right(j);
  }
  for (int j = n - 1; j >= 0; --j) {
    right(j) *= fit.inverse_pivots(j);
    for (int i = j + 1; i < n; ++i) right(j) -= fit.lower(i, j) * right(i);
  }
  fit.state = right;
  return fit;
}

ExternalDeviation ChangeFitter::external(std::size_t i, const ChangeFit& fit, bool kept) const {
  const ChangeRow& row = rows_.rows[i];
  const double variance = row.sigma * row.sigma * fit.scale * fit.scale;
  ChangeVector y = row.h;
  double predicted = 0.0;
  for (int j = 0; j < rows_.unknowns; ++j) {
    predicted += y(j) * y(j) * fit.inverse_pivots(j);
    for (int k = j + 1; k < rows_.unknowns; ++k) y(k) -= fit.lower(k, j) * y(j);
  }
  const double value = deviation(row, fit);
  if (!kept) return {value, std::sqrt(variance + predicted)};
  const double free = 1.0 - predicted / variance;  // local redundancy
  if (free < kMinLocalRedundancy) return {};
  return {value / free, std::sqrt(variance / free)};
}

// This is external() squared: a kept row deviates by value / free with a variance of variance /
// free.
ChangeSet ChangeFitter::agreeing(const ChangeSet& kept, const ChangeFit& fit) const {
  const double limit = config_.range_change_limit * config_.range_change_limit;
  ChangeSet next;
  std::size_t row = 0;
  for (const Block& block : blocks_) {
    std::array<Lanes, kChangeUnknowns> y;
    Lanes predicted = Lanes::Zero(), value = block.residual;
    for (std::size_t a = 0; a < static_cast<std::size_t>(rows_.unknowns); ++a) {
      const auto at = static_cast<Eigen::Index>(a);
      Lanes rest = block.h[a];
      value -= fit.state(at) * rest;
      for (std::size_t b = 0; b < a; ++b)
        rest -= fit.lower(at, static_cast<Eigen::Index>(b)) * y[b];
      y[a] = rest;
      predicted += fit.inverse_pivots(at) * rest.square();
    }
    const Lanes variance = fit.scale * fit.scale * block.variance;
    const Lanes square = value.square();
    for (Eigen::Index lane = 0; lane < static_cast<Eigen::Index>(kLanes) && row < size();
         ++lane, ++row) {
      const double free = 1.0 - predicted(lane) / variance(lane);
      const bool agrees =
          kept.test(row)
              ? free < kMinLocalRedundancy || square(lane) <= limit * free * variance(lane)
              : square(lane) <= limit * (variance(lane) + predicted(lane));
      next.set(row, agrees);
    }
  }
  return next;
}

ChangeSet ChangeFitter::nearest_half(const ChangeFit& fit, std::size_t more) const {
  boost::container::static_vector<double, kMaxSatellites> values, sorted;
  for (const ChangeRow& row : rows_.rows) {
    values.push_back(std::abs(deviation(row, fit)) / row.sigma);
  }
  sorted = values;
  const std::size_t half = std::min((values.size() + more + 1) / 2, values.size() - 1) - 1;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(half),
                   sorted.end());
  ChangeSet kept;
  for (std::size_t i = 0; i < values.size(); ++i) kept.set(i, values[i] <= sorted[half]);
  return kept;
}

double ChangeFitter::cost(const ChangeSet& kept, const ChangeFit& fit) const {
  double sum = fit.state.squaredNorm();
  for (std::size_t i = 0; i < size(); ++i) {
    const double w = deviation(rows_.rows[i], fit) / (rows_.rows[i].sigma * fit.scale);
    sum += kept.test(i) ? w * w : config_.range_change_limit * config_.range_change_limit;
  }
  return sum;
}

double ChangeFitter::parameters(const ChangeSet& kept) const {
  ChangeFit fit;
  fit.lower.setIdentity();
  for (std::size_t i = 0; i < size(); ++i) {
    if (!kept.test(i)) continue;
    const ChangeRow& row = rows_.rows[i];
    const double sigma = std::max(row.sigma, kQuarterCycle_m);
    add_square(row.h, 1.0 / (sigma * sigma), rows_.unknowns, &fit.lower);
  }
  factorize(&fit);
  double trace = 0.0;  // of the inverse
  for (int unit = 0; unit < rows_.unknowns; ++unit) {
    ChangeVector y = ChangeVector::Zero();
    y(unit) = 1.0;
    for (int j = unit; j < rows_.unknowns; ++j) {
      trace += y(j) * y(j) * fit.inverse_pivots(j);
      for (int k = j + 1; k < rows_.unknowns; ++k) y(k) -= fit.lower(k, j) * y(j);
    }
  }
  return static_cast<double>(rows_.unknowns) - trace;
}

double ChangeFitter::scatter(const ChangeSet& kept, double scale) const {
  const double spare = static_cast<double>(kept.count()) - parameters(kept);
  if (spare < 2.0) return 0.0;
  const ChangeFit of_kept = fit(kept, scale);
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (!kept.test(i)) continue;
    const double w = deviation(rows_.rows[i], of_kept) / rows_.rows[i].sigma;
    sum += w * w;
  }
  return std::sqrt(sum / spare);
}

}  // namespace leonav
