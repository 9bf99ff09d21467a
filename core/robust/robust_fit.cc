#include "core/robust/robust_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>

#include "core/robust/internal/consensus.h"

namespace leonav {
namespace {

constexpr int kMaxNewtonSteps = 15;
constexpr int kL1Steps = 15;
constexpr int kPolishSteps = 5;
// A plain fit whose largest w-test stays below this has no gross error to search for.
constexpr double kSuspicious = 3.0;
constexpr int kMaxExclusions = 16;
// Below this ratio of pivots the geometry does not determine the unknowns.
constexpr double kMinPivotRatio = 1.0e-11;
// Sizes of a step as step^T N step, that is in units of the result's own standard deviations,
// squared.
constexpr double kNegligibleStep = 1.0e-8;
constexpr double kConvergedStep = 0.25;

using Satellites = std::bitset<kMaxSatellites>;

struct Step {
  FitStatus status = FitStatus::kTooFewRows;
  double size = 0.0;  // step^T N step
};

class Fit {
 public:
  Fit(const FitModel& model, FitState* state, FitRows* rows)
      : model_(model), state_(state), rows_(rows) {}

  FitStatus plain();
  FitStatus robust(const RobustConfig& config);
  FitResult result(FitStatus status) const;

 private:
  void exclude_single_satellite_groups();
  Step step();
  template <typename Factor>
  FitStatus iterate(int steps, Factor factor);
  void estimate_scale();
  FitRow* worst_row(double limit);
  FitStatus restart_from_consensus(const RobustConfig& config);
  FitStatus snoop(const RobustConfig& config);

  const FitModel& model_;
  FitState* state_;
  FitRows* rows_;
  FitMatrix inverse_ = FitMatrix::Zero();
  double scale_ = 1.0;
  int redundancy_ = 0;
  int unknowns_ = 3;
};

FitState jacobian_of(const FitRow& row) {
  FitState jacobian = FitState::Zero();
  jacobian.head<3>() = row.direction;
  jacobian(3 + row.group) = 1.0;
  return jacobian;
}

double weight_of(const FitRow& row) { return row.factor / (row.sigma * row.sigma); }

void Fit::exclude_single_satellite_groups() {
  std::array<Satellites, kMaxSystemTimes> satellites;
  for (FitRow& row : *rows_) {
    row.single_in_group = false;
    if (row.in_use())
      satellites[static_cast<std::size_t>(row.group)].set(static_cast<std::size_t>(row.satellite));
  }
  std::size_t total = 0;
  unknowns_ = 3;
  for (const Satellites& group : satellites) {
    if (group.count() < 2) continue;
    total += group.count();
    ++unknowns_;
  }
  redundancy_ = -unknowns_;
  for (FitRow& row : *rows_) {
    row.single_in_group = satellites[static_cast<std::size_t>(row.group)].count() < 2;
    if (row.in_use()) ++redundancy_;
  }
  // Two signals of one satellite are two rows but one direction.
  if (total < static_cast<std::size_t>(unknowns_)) redundancy_ = -1;
}

// Takes one Gauss-Newton step with the factors as they are; residuals are those before the step.
Step Fit::step() {
  exclude_single_satellite_groups();
  if (redundancy_ < 0 || unknowns_ < 4) return {FitStatus::kTooFewRows, 0.0};
  FitMatrix normal = FitMatrix::Zero();
  FitState right = FitState::Zero();
  for (const FitRow& row : *rows_) {
    if (!row.in_use()) continue;
    const FitState jacobian = jacobian_of(row);
    normal += weight_of(row) * jacobian * jacobian.transpose();
    right += weight_of(row) * row.residual * jacobian;
  }
  const double unit = normal.diagonal().maxCoeff();
  for (int i = 3; i < kFitUnknowns; ++i) {
    if (normal(i, i) == 0.0) normal(i, i) = unit;  // a clock without rows stays where it is
  }
  const Eigen::LDLT<FitMatrix> factor(normal);
  if (factor.info() != Eigen::Success || !factor.isPositive() ||
      !(factor.vectorD().minCoeff() > kMinPivotRatio * factor.vectorD().maxCoeff())) {
    return {FitStatus::kSingular, 0.0};
  }
  const FitState change = factor.solve(right);
  if (!change.allFinite()) return {FitStatus::kSingular, 0.0};
  inverse_ = factor.solve(FitMatrix::Identity());
  *state_ += change;
  model_.linearize(*state_, rows_);
  return {FitStatus::kOk, change.dot(normal * change)};
}

// Iterates Gauss-Newton, renewing each row's factor by `factor(row)` before each step.
template <typename Factor>
FitStatus Fit::iterate(int steps, Factor factor) {
  Step last;
  for (int i = 0; i < steps; ++i) {
    for (FitRow& row : *rows_) row.factor = factor(row);
    last = step();
    if (last.status != FitStatus::kOk) return last.status;
    if (last.size < kNegligibleStep) break;
  }
  return last.size < kConvergedStep ? FitStatus::kOk : FitStatus::kNotConverged;
}

FitStatus Fit::plain() {
  model_.linearize(*state_, rows_);
  return iterate(kMaxNewtonSteps, [](const FitRow&) { return 1.0; });
}

void Fit::estimate_scale() {
  StandardizedResiduals standardized;
  for (const FitRow& row : *rows_) {
    if (!row.single_in_group && !row.excluded)
      standardized.push_back(std::abs(row.residual) / row.sigma);
  }
  const std::size_t unknowns = static_cast<std::size_t>(unknowns_);
  // With fewer than four degrees of freedom a median of the rest may itself be the gross error.
  if (standardized.size() < unknowns + 4) {
    scale_ = 1.0;
    return;
  }
  scale_ = std::clamp(robust_scale(&standardized, unknowns), 1.0, kMaxFitScale);
}

// Returns the row whose residual is largest relative to its own standard deviation (Baarda's
// w-test), if beyond `limit`; otherwise nullptr.
FitRow* Fit::worst_row(double limit) {
  FitRow* worst = nullptr;
  double largest = limit;
  for (FitRow& row : *rows_) {
    if (!row.in_use()) continue;
    const FitState jacobian = jacobian_of(row);
    const double leverage = weight_of(row) * jacobian.dot(inverse_ * jacobian);
    const double free = 1.0 - leverage;
    if (free < 1.0e-6) continue;  // no other row checks this one
    const double w = std::abs(row.residual) / (row.sigma * scale_ * std::sqrt(free));
    if (w > largest) {
      largest = w;
      worst = &row;
    }
  }
  return worst;
}

FitStatus Fit::snoop(const RobustConfig& config) {
  const auto igg3 = [&](const FitRow& row) {
    return igg3_factor(row.residual / (row.sigma * scale_), config.k0, config.k1);
  };
  FitStatus status = FitStatus::kOk;
  for (int i = 0; i < kMaxExclusions; ++i) {
    FitRow* worst = worst_row(config.k1);
    if (worst == nullptr) return status;
    if (redundancy_ < 2) return FitStatus::kFaulty;
    worst->excluded = true;
    status = iterate(kPolishSteps, igg3);
    if (status == FitStatus::kTooFewRows || status == FitStatus::kSingular) {
      return FitStatus::kFaulty;
    }
  }
  return FitStatus::kFaulty;
}

// Moves the start to the state that most rows agree on, if it differs, and excludes the rows that
// disagree there, so that the scale of the others is estimated without them.
FitStatus Fit::restart_from_consensus(const RobustConfig& config) {
  for (FitRow& row : *rows_) row.factor = 1.0;
  const std::optional<Consensus> consensus = find_consensus(*rows_);
  if (!consensus) return FitStatus::kOk;
  *state_ += consensus->change;
  model_.linearize(*state_, rows_);
  return iterate(kPolishSteps, [&](const FitRow& row) {
    return igg3_factor(row.residual / (row.sigma * consensus->scale), config.k0, config.k1);
  });
}

FitStatus Fit::robust(const RobustConfig& config) {
  const bool suspicious = worst_row(kSuspicious) != nullptr;
  FitStatus status = iterate(kL1Steps, [](const FitRow& row) {
    return 1.0 / std::max(std::abs(row.residual) / row.sigma, 1.0);
  });
  if (status == FitStatus::kTooFewRows || status == FitStatus::kSingular) return status;
  if (suspicious) {
    status = restart_from_consensus(config);
    if (status == FitStatus::kTooFewRows || status == FitStatus::kSingular) return status;
  }
  estimate_scale();
  // The iterations that suffice from a prediction may be too few from a point solution's start; a
  // fit is cheap.
  // fit is cheap.
  status = iterate(std::max(config.max_iterations, kMaxNewtonSteps), [&](const FitRow& row) {
    return igg3_factor(row.residual / (row.sigma * scale_), config.k0, config.k1);
  });
  if (status == FitStatus::kTooFewRows) return FitStatus::kFaulty;
  if (status == FitStatus::kSingular) return status;
  const FitStatus snooped = snoop(config);
  return snooped == FitStatus::kOk && status != FitStatus::kOk ? status : snooped;
}

FitResult Fit::result(FitStatus status) const {
  FitResult result;
  result.status = status;
  result.scale = scale_;
  result.redundancy = redundancy_;
  result.covariance = scale_ * scale_ * inverse_;
  return result;
}

}  // namespace

FitResult robust_fit(const FitModel& model, const RobustConfig& robust, FitState* state,
                     FitRows* rows) {
  for (FitRow& row : *rows) {
    row.factor = 1.0;
    row.excluded = false;
  }
  Fit fit(model, state, rows);
  FitStatus status = fit.plain();
  if (status == FitStatus::kOk && robust.enabled) status = fit.robust(robust);
  return fit.result(status);
}

}  // namespace leonav
