#include "core/smoother/internal/window_cost.h"

#include <Eigen/Cholesky>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <limits>

#include "core/smoother/linearization.h"

namespace leonav {
namespace {

using Eigen::Index;

// 0.5 a^2 - 0.5 b^2, without the rounding of either square
double half_square_rise(double a, double b) { return 0.5 * (a + b) * (a - b); }

// Of 0.5 x^T information x - gradient^T x.
template <typename Information, typename Gradient, typename Vector>
double quadratic_rise(const Information& information, const Gradient& gradient, const Vector& now,
                      const Vector& then) {
  const EkfCorrection change = now - then;
  EkfCorrection slope = -gradient;
  slope.noalias() += 0.5 * (information * (now + then));
  return slope.dot(change);
}

double prior_rise(const WindowPrior& prior, const Keyframe& first, const FilterState& before) {
  const EkfCorrection now = active_part(first.active, difference(first.state, prior.at));
  const EkfCorrection then = active_part(first.active, difference(before, prior.at));
  return quadratic_rise(prior.information, prior.gradient, now, then);
}

double measurements_rise(const Keyframe& keyframe, const FilterState& before,
                         const Eigen::Vector3d& lever_arm_b) {
  const AntennaMotion antenna = antenna_of(keyframe, keyframe.state, lever_arm_b);
  const AntennaMotion antenna_before = antenna_of(keyframe, before, lever_arm_b);
  double rise = 0.0;
  for (const KeyframeMeasurement& measurement : keyframe.measurements) {
    const double weight = measurement.factor / measurement.gain_variance;
    if (!(weight > 0.0)) continue;
    const double now = linearize(measurement, keyframe, keyframe.state, antenna).residual;
    const double then = linearize(measurement, keyframe, before, antenna_before).residual;
    rise += weight * half_square_rise(now, then);
  }
  return rise;
}

// Of what motion constraints and joined arcs tell about the keyframe before `process_factor`.
double information_rise(const ProcessFactor& process_factor, const Keyframe& keyframe,
                        const FilterState& before) {
  double rise = 0.0;
  for (const ArcJoin& join : process_factor.joins) {
    const auto residual = [&join](const FilterState& state) {
      return join.difference_m - (state.ambiguities[static_cast<std::size_t>(join.to)].value_m -
                                  state.ambiguities[static_cast<std::size_t>(join.from)].value_m);
    };
    rise += half_square_rise(residual(keyframe.state), residual(before)) / join.variance;
  }
  if (!process_factor.has_information) return rise;
  const Index core = keyframe.active.core_size();
  const auto moved = [&](const FilterState& state) -> EkfCorrection {
    return active_part(keyframe.active, difference(state, process_factor.from)).head(core);
  };
  return rise + quadratic_rise(process_factor.information, process_factor.gradient.head(core),
                               moved(keyframe.state), moved(before));
}

// Of e^T N^-1 e / 2, with the errors `now` and `then` of a process. The states whose noise is their
// own are one term each: nearly all ambiguities.
double noise_rise(const EkfCovariance& noise, Index core, const EkfCorrection& now,
                  const EkfCorrection& then) {
  boost::container::static_vector<Index, static_cast<std::size_t>(ekf_index::kMaxSize)> common;
  double rise = 0.0;
  for (Index i = 0; i < noise.rows(); ++i) {
    if (noise(i, i) == 0.0) continue;
    const bool alone = i >= core && noise.col(i).cwiseAbs().sum() == noise(i, i);
    if (alone)
      rise += half_square_rise(now(i), then(i)) / noise(i, i);
    else
      common.push_back(i);
  }
  const auto count = static_cast<Index>(common.size());
  if (count == 0) return rise;
  EkfCovariance root(count, count);
  BoundedMatrix<ekf_index::kMaxSize, 2> whitened(count, 2);  // sum and difference of both
  // The diagonal spans many orders of magnitude.
  EkfCorrection scale(count);
  for (Index j = 0; j < count; ++j) {
    const Index state = common[static_cast<std::size_t>(j)];
    scale(j) = 1.0 / std::sqrt(noise(state, state));
    whitened(j, 0) = scale(j) * (now(state) + then(state));
    whitened(j, 1) = scale(j) * (now(state) - then(state));
  }
  for (Index j = 0; j < count; ++j)
    for (Index i = j; i < count; ++i)
      root(i, j) = scale(i) * scale(j) *
                   noise(common[static_cast<std::size_t>(i)], common[static_cast<std::size_t>(j)]);
  const Eigen::LLT<Eigen::Ref<EkfCovariance>, Eigen::Lower> factorized(root);
  if (factorized.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  root.triangularView<Eigen::Lower>().solveInPlace(whitened);
  return rise + 0.5 * whitened.col(0).dot(whitened.col(1));
}

}  // namespace

double cost_rise(const Window& window, const FilterState* before,
                 const Eigen::Vector3d& lever_arm_b) {
  double rise = prior_rise(window.prior(), window.at(0), before[0]);
  for (int i = 0; i < window.size(); ++i) {
    const Keyframe& keyframe = window.at(i);
    rise += measurements_rise(keyframe, before[i], lever_arm_b);
    if (i == 0) continue;
    const Keyframe& last = window.at(i - 1);
    rise += information_rise(keyframe.process_factor, last, before[i - 1]);
    rise += noise_rise(keyframe.process_factor.noise, keyframe.active.core_size(),
                       process_error(last.active, last.state, keyframe, keyframe.state),
                       process_error(last.active, before[i - 1], keyframe, before[i]));
  }
  return rise;
}

}  // namespace leonav
