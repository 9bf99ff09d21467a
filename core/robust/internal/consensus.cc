#include "core/robust/internal/consensus.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/robust/random_subset.h"

namespace leonav {
namespace {

// With a quarter of the satellites wrong and seven unknowns, one subset in seven is free of errors;
// all 100 contain an error with a probability of 1e-6.
constexpr int kSubsets = 100;
// Beyond this many sigmas every residual costs the same. With a larger bound, a fit that spreads
// three errors over all rows would cost less than the right one, which leaves three rows far off.
constexpr double kBound = 2.5;
// A vote needs twice as many spare satellites as errors that it must outvote; for one error the L1
// start suffices.
constexpr std::size_t kMinRedundancy = 4;
constexpr double kMinSubsetPivotRatio = 1.0e-7;  // a subset of weaker geometry determines nothing

struct Candidate {
  FitState change = FitState::Zero();
  double scale = std::numeric_limits<double>::infinity();
};

class Search {
 public:
  explicit Search(const FitRows& rows);
  std::optional<Consensus> run();

 private:
  using Places = boost::container::static_vector<std::size_t, kMaxSatellites>;

  void draw_subset();
  template <typename Chosen>
  bool fit(Chosen chosen, FitState* change) const;
  void standardize(const FitState& change);
  bool improve(FitState* change);
  double bounded_sum(const FitState& change, double scale);

  boost::container::static_vector<const FitRow*, kMaxMeasurements> rows_;
  std::array<Places, kMaxSystemTimes> satellites_;  // by group
  Places all_;
  std::array<bool, kMaxSatellites> chosen_{};
  std::array<double, kMaxMeasurements> standardized_{};
  std::size_t unknowns_ = 3;
  RandomDraw draw_;
};

Search::Search(const FitRows& rows) {
  std::array<bool, kMaxSatellites> seen{};
  for (const FitRow& row : rows) {
    if (!row.in_use()) continue;
    rows_.push_back(&row);
    const std::size_t satellite = static_cast<std::size_t>(row.satellite);
    if (seen[satellite]) continue;
    seen[satellite] = true;
    all_.push_back(satellite);
    satellites_[static_cast<std::size_t>(row.group)].push_back(satellite);
  }
  for (const Places& group : satellites_) unknowns_ += group.empty() ? 0 : 1;
}

// Draws as many satellites as unknowns: one of each group for its clock, and three of any group.
void Search::draw_subset() {
  chosen_.fill(false);
  std::size_t missing = 3;
  for (const Places& group : satellites_) {
    if (!group.empty()) chosen_[group[draw_.below(group.size())]] = true;
  }
  while (missing > 0) {
    bool& place = chosen_[all_[draw_.below(all_.size())]];
    if (place) continue;
    place = true;
    --missing;
  }
}

template <typename Chosen>
bool Search::fit(Chosen chosen, FitState* change) const {
  FitMatrix normal = FitMatrix::Zero();
  FitState right = FitState::Zero();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!chosen(i)) continue;
    const FitRow& row = *rows_[i];
    const double weight = 1.0 / (row.sigma * row.sigma);
    const int clock = 3 + row.group;
    const Eigen::Vector3d weighted = weight * row.direction;
    normal.topLeftCorner<3, 3>() += weighted * row.direction.transpose();
    normal.block<3, 1>(0, clock) += weighted;
    normal(clock, clock) += weight;
    right.head<3>() += row.residual * weighted;
    right(clock) += row.residual * weight;
  }
  normal.bottomLeftCorner<kFitUnknowns - 3, 3>() =
      normal.topRightCorner<3, kFitUnknowns - 3>().transpose();
  const double unit = normal.diagonal().maxCoeff();
  for (int i = 3; i < kFitUnknowns; ++i) {
    if (normal(i, i) == 0.0) normal(i, i) = unit;
  }
  const Eigen::LDLT<FitMatrix> factor(normal);
  if (factor.info() != Eigen::Success ||
      !(factor.vectorD().minCoeff() > kMinSubsetPivotRatio * factor.vectorD().maxCoeff())) {
    return false;
  }
  *change = factor.solve(right);
  return change->allFinite();
}

void Search::standardize(const FitState& change) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const FitRow& row = *rows_[i];
    const double moved = row.direction.dot(change.head<3>()) + change(3 + row.group);
    standardized_[i] = std::abs(row.residual - moved) / row.sigma;
  }
}

// Fits the rows nearest to `change`: half of the rows plus half of the unknowns, which tolerates
// the largest number of errors. A clock whose rows all lie far off keeps its value.
bool Search::improve(FitState* change) {
  standardize(*change);
  std::array<double, kMaxMeasurements> sorted = standardized_;
  const std::size_t half = std::min((rows_.size() + unknowns_ + 1) / 2, rows_.size()) - 1;
  const auto begin = sorted.begin();
  std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(half),
                   begin + static_cast<std::ptrdiff_t>(rows_.size()));
  const double limit = sorted[half];
  std::array<bool, kMaxSystemTimes> fitted{};
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (standardized_[i] <= limit) fitted[static_cast<std::size_t>(rows_[i]->group)] = true;
  }
  FitState improved;
  if (!fit([&](std::size_t i) { return standardized_[i] <= limit; }, &improved)) return false;
  for (std::size_t group = 0; group < fitted.size(); ++group) {
    const int clock = 3 + static_cast<int>(group);
    if (!fitted[group]) improved(clock) = (*change)(clock);
  }
  *change = improved;
  return true;
}

double Search::bounded_sum(const FitState& change, double scale) {
  standardize(change);
  double sum = 0.0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double v = std::min(standardized_[i] / scale, kBound);
    sum += v * v;
  }
  return sum;
}

// Returns the quantile of the standard normal distribution for p >= 0.5 (M. Abramowitz and I. A.
// Stegun, Handbook of Mathematical Functions, 1964, 26.2.23: accurate to 4.5e-4).
double normal_quantile(double p) {
  const double t = std::sqrt(-2.0 * std::log(1.0 - p));
  return t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                 (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
}

std::optional<Consensus> Search::run() {
  if (all_.size() < unknowns_ + kMinRedundancy || unknowns_ < 4) return std::nullopt;
  std::array<Candidate, kSubsets + 1> candidates;  // the first one is: no change
  double scale = kMaxFitScale;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Candidate& candidate = candidates[i];
    if (i > 0) {
      draw_subset();
      const auto of_subset = [&](std::size_t row) {
        return chosen_[static_cast<std::size_t>(rows_[row]->satellite)];
      };
      if (!fit(of_subset, &candidate.change) || !improve(&candidate.change)) continue;
    }
    standardize(candidate.change);
    StandardizedResiduals values(standardized_.begin(),
                                 standardized_.begin() + static_cast<std::ptrdiff_t>(rows_.size()));
    candidate.scale = robust_scale(&values, unknowns_);
    scale = std::min(scale, candidate.scale);
  }
  scale = std::max(scale, 1.0);
  std::size_t best = 0;
  double least = bounded_sum(candidates[0].change, scale) - kBound * kBound;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    if (!std::isfinite(candidates[i].scale)) continue;
    const double sum = bounded_sum(candidates[i].change, scale);
    if (!(sum < least)) continue;
    least = sum;
    best = i;
  }
  return Consensus{candidates[best].change, scale};
}

}  // namespace

double robust_scale(StandardizedResiduals* standardized, std::size_t unknowns) {
  const std::size_t place =
      std::min((standardized->size() + unknowns) / 2, standardized->size() - 1);
  const auto middle = standardized->begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(standardized->begin(), middle, standardized->end());
  const double count = static_cast<double>(standardized->size());
  const double share = (static_cast<double>(place) + 0.5) / count;
  const double free = std::max(1.0 - static_cast<double>(unknowns) / count, 0.0);
  return *middle / (std::sqrt(free) * normal_quantile(0.5 + 0.5 * share));
}

std::optional<Consensus> find_consensus(const FitRows& rows) { return Search(rows).run(); }

}  // namespace leonav
