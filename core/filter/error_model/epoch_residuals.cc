#include "core/filter/error_model/epoch_residuals.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/robust/igg3.h"

namespace leonav {
namespace {

using namespace ekf_index;

constexpr int kClocks = static_cast<int>(kMaxSystemTimes);
constexpr int kKnown = 4;  // position and ionosphere, known from before
constexpr int kUnknowns = kKnown + kClocks;
constexpr double kHuber = 1.5;
// The filter's position counts with so many of its sigmas: it may be wrong by more than it says,
// and where few satellites are left nothing else shows that some of them are reflected.
constexpr double kPriorFactor = 3.0;
// The first passes hold the position to the prediction, so that codes which are off together cannot
// pull it; from then on they weigh nothing beyond kRejected sigmas.
constexpr int kTightPasses = 3, kPasses = 8;
constexpr double kRejected = 5.0;
// Weak information, m^-2, that keeps the normal matrix regular where a system is absent: its clock
// has no measurement and stays zero.
constexpr double kRegular = 1e-9;
// Variance of the ionosphere, m^2, that keeps its covariance regular where it is not estimated.
constexpr double kLeastIonosphere_m2 = 1e-6;
// A position less certain than this by the codes alone, m, with the configured sigmas, tells
// nothing.
constexpr double kMostSigma_m = 300.0;

using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;

Unknowns row_of(const FilterMeasurement& code) {
  Unknowns row;
  row << code.row.segment<3>(kPosition), code.row(kIonosphere), code.row.segment<kClocks>(kClock);
  return row;
}

}  // namespace

EpochResiduals code_residuals(const FilterMeasurements& measurements,
                              const Eigen::Matrix4d& known_covariance) {
  EpochResiduals residuals;
  boost::container::static_vector<double, kMaxMeasurements> psi;
  Unknowns seen = Unknowns::Zero();
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const FilterMeasurement& code = measurements[i];
    if (code.observable != Observable::kCode || !(code.variance > 0.0)) continue;
    residuals.push_back({i, code.innovation, code.variance, 0.0});
    psi.push_back(1.0);
    seen += row_of(code).cwiseAbs();
  }
  seen(kKnown - 1) = 0.0;  // the ionosphere is known from before
  const auto unknowns = static_cast<std::size_t>((seen.array() > 0.0).count());
  if (residuals.size() <= unknowns) return {};

  Normal prior = kRegular * Normal::Identity(), tight = prior;
  Eigen::Matrix4d covariance_of_known = known_covariance;
  covariance_of_known(3, 3) += kLeastIonosphere_m2;
  const Eigen::LLT<Eigen::Matrix4d> known(kPriorFactor * kPriorFactor * covariance_of_known);
  if (known.info() != Eigen::Success) return {};
  const Eigen::Matrix4d information = known.solve(Eigen::Matrix4d::Identity());
  prior.topLeftCorner<kKnown, kKnown>() += information;
  tight.topLeftCorner<kKnown, kKnown>() += kPriorFactor * kPriorFactor * information;

  Normal inverse;
  for (int pass = 0; pass < kPasses; ++pass) {
    Normal normal = pass < kTightPasses ? tight : prior;
    Unknowns right = Unknowns::Zero();
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      const FilterMeasurement& code = measurements[residuals[i].index];
      const Unknowns row = row_of(code);
      const double weight = psi[i] / code.variance;
      normal += weight * row * row.transpose();
      right += weight * code.innovation * row;
    }
    const Eigen::LLT<Normal> factor(normal);
    if (factor.info() != Eigen::Success) return {};
    inverse = factor.solve(Normal::Identity());
    const Unknowns solution = inverse * right;
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      const FilterMeasurement& code = measurements[residuals[i].index];
      residuals[i].residual = code.innovation - row_of(code).dot(solution);
      if (pass + 1 == kPasses) continue;
      const double ratio = std::abs(residuals[i].residual) / std::sqrt(code.variance);
      psi[i] = pass + 1 < kTightPasses ? (ratio > kHuber ? kHuber / ratio : 1.0)
                                       : igg3_factor(ratio, kHuber, kRejected);
    }
  }
  if (!(inverse.topLeftCorner<3, 3>().trace() < kMostSigma_m * kMostSigma_m)) return {};

  Normal spread = Normal::Zero();  // H^T W R W H
  spread.topLeftCorner<kKnown, kKnown>() = information * covariance_of_known * information;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const FilterMeasurement& code = measurements[residuals[i].index];
    const Unknowns row = row_of(code);
    spread += psi[i] * psi[i] / code.variance * row * row.transpose();
  }
  const Normal covariance = inverse * spread * inverse;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const FilterMeasurement& code = measurements[residuals[i].index];
    const Unknowns row = row_of(code);
    const double leverage = psi[i] * row.dot(inverse * row);
    residuals[i].variance =
        std::max(code.variance - 2.0 * leverage + row.dot(covariance * row), 0.0);
    residuals[i].redundancy = std::clamp(1.0 - leverage / code.variance, 0.0, 1.0);
  }
  return residuals;
}

}  // namespace leonav
