#include "core/integrity/level_growth.h"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <numbers>

#include "core/integrity/level_equation.h"
#include "core/integrity/risk.h"

namespace leonav {
namespace {

// The share of the risk that bounds the multiples of sigma between epochs.
constexpr double kGrowthShare = 0.01;

using LevelTerms = boost::container::static_vector<LevelTerm, kMaxFaultHypotheses + 1>;

// A variance that rounding has made slightly negative gives zero.
double sigma_along(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& axis) {
  const double variance = axis.dot(covariance * axis);
  return variance < 0.0 ? 0.0 : std::sqrt(variance);
}

// Returns the unit vectors of major axis, minor axis and down.
std::array<Eigen::Vector3d, 3> axes_of_ellipse(const Eigen::Matrix3d& covariance_n) {
  const double angle =
      0.5 * std::atan2(2.0 * covariance_n(0, 1), covariance_n(0, 0) - covariance_n(1, 1));
  const double c = std::cos(angle), s = std::sin(angle);
  return {Eigen::Vector3d(c, s, 0.0), Eigen::Vector3d(-s, c, 0.0), Eigen::Vector3d::UnitZ()};
}

// Returns the terms of all hypotheses, the first that of no fault. `offset` and `variance` give the
// separation of a hypothesis in this dimension.
template <typename Offset, typename Variance>
LevelTerms terms_of(double sigma, double bias, std::span<const FaultHypothesis> hypotheses,
                    Offset offset, Variance variance) {
  LevelTerms terms = {{1.0, bias, sigma}};
  for (const FaultHypothesis& fault : hypotheses) {
    if (terms.size() == terms.capacity()) break;
    const double total = sigma * sigma + std::max(0.0, variance(fault));
    terms.push_back({fault.probability, bias + std::abs(offset(fault)), std::sqrt(total)});
    terms.front().probability -= fault.probability;
  }
  terms.front().probability = std::max(0.0, terms.front().probability);
  return terms;
}

LevelTerms terms_along(const Eigen::Vector3d& axis, const NominalError& nominal,
                       std::span<const FaultHypothesis> hypotheses) {
  const double bias = axis.cwiseAbs().dot(nominal.position_bias_n.cwiseAbs());
  return terms_of(
      sigma_along(nominal.position_covariance_n, axis), bias, hypotheses,
      [&](const FaultHypothesis& fault) { return axis.dot(fault.separation_n); },
      [&](const FaultHypothesis& fault) { return axis.dot(fault.separation_covariance_n * axis); });
}

LevelTerms heading_terms(const NominalError& nominal, std::span<const FaultHypothesis> hypotheses) {
  return terms_of(
      std::sqrt(nominal.heading_variance), 0.0, hypotheses,
      [](const FaultHypothesis& fault) { return fault.heading_separation; },
      [](const FaultHypothesis& fault) { return fault.heading_separation_variance; });
}

// Returns the multiple of sigma that an error exceeds with probability `risk`.
double multiple_of_sigma(double risk, const Overbound& overbound) {
  const LevelTerm unit = {1.0, 0.0, 1.0};
  return solve_level({&unit, 1}, risk, overbound);
}

}  // namespace

LevelGrowth::LevelGrowth(const NominalError& epoch, std::span<const FaultHypothesis> hypotheses,
                         const IntegrityConfig& config)
    : axes_n_(axes_of_ellipse(epoch.position_covariance_n)) {
  const auto solve = [&](const LevelTerms& terms, double risk) {
    const double set_aside = terms.size() > 1 ? kGrowthShare * risk : 0.0;
    const double of_each = set_aside / static_cast<double>(terms.size());
    const Overbound& overbound = config.overbound;
    return Component{solve_level({terms.data(), terms.size()}, risk - set_aside, overbound),
                     terms.front().sigma,
                     multiple_of_sigma(set_aside > 0.0 ? of_each : risk, overbound)};
  };
  const double risk = risk_per_sample(config.risk_per_hour, config.error_correlation_s);
  const std::array<double, 3> shares = {0.5 * risk, 0.5 * risk, risk};
  for (std::size_t i = 0; i < axes_n_.size(); ++i)
    position_[i] = solve(terms_along(axes_n_[i], epoch, hypotheses), shares[i]);
  heading_ = solve(heading_terms(epoch, hypotheses), risk);
}

double LevelGrowth::Component::at(double sigma_now) const {
  // A maximum would turn NaN to the other value.
  return sigma_now <= sigma ? level : level + growth * (sigma_now - sigma);
}

ProtectionLevels LevelGrowth::at(const NominalError& now) const {
  std::array<double, 3> along{};
  for (std::size_t i = 0; i < axes_n_.size(); ++i)
    along[i] = position_[i].at(sigma_along(now.position_covariance_n, axes_n_[i]));
  const double heading = heading_.at(std::sqrt(now.heading_variance));
  return {std::hypot(along[0], along[1]), along[2],
          heading > std::numbers::pi ? std::numbers::pi : heading};
}

}  // namespace leonav
