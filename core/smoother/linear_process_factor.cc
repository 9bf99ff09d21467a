#include "core/smoother/linear_process_factor.h"

#include <algorithm>
#include <cmath>

#include "core/earth/rotation.h"

namespace leonav {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Expands 0.5 (x - at)^T information (x - at) - gradient^T (x - at) about the keyframe's estimate,
// in place.
void linearize_quadratic(const Keyframe& keyframe, const FilterState& at,
                         EkfCovariance* information, EkfCorrection* gradient) {
  const EkfCorrection moved = active_part(keyframe.active, difference(keyframe.state, at));
  turn_to_errors(attitude_jacobian(keyframe.active, keyframe.state, at), moved, information,
                 gradient);
}

void add_joins(const Keyframe& before, const ArcJoins& joins, EkfCovariance* information,
               EkfCorrection* gradient) {
  const Ambiguities& ambiguities = before.state.ambiguities;
  for (const ArcJoin& join : joins) {
    const Eigen::Index from = before.active.core_size() + join.from;
    const Eigen::Index to = before.active.core_size() + join.to;
    const double weight = 1.0 / join.variance;
    const double residual =
        join.difference_m - (ambiguities[static_cast<std::size_t>(join.to)].value_m -
                             ambiguities[static_cast<std::size_t>(join.from)].value_m);
    (*information)(from, from) += weight;
    (*information)(to, to) += weight;
    (*information)(from, to) -= weight;
    (*information)(to, from) -= weight;
    (*gradient)(from) -= weight * residual;
    (*gradient)(to) += weight * residual;
  }
}

}  // namespace

AttitudeJacobian attitude_jacobian(const ActiveStates& active, const CoreState& estimate,
                                   const CoreState& linearized_at) {
  AttitudeJacobian change;
  const auto found = std::find(active.core.begin(), active.core.end(), ekf_index::kAttitude);
  if (found == active.core.end()) return change;
  change.index = found - active.core.begin();
  const Vector3d turned =
      rotation_vector_from_quaternion(estimate.nav.q_eb * linearized_at.nav.q_eb.conjugate());
  const double angle = turned.norm();
  const Matrix3d S = skew(turned);
  // (1 - cos x) / x^2, (x - sin x) / x^3 and (1 - x/2 cot(x/2)) / x^2, as series near zero.
  double a = 0.5, b = 1.0 / 6.0, c = 1.0 / 12.0;
  const double square = angle * angle;
  if (angle < 1e-2) {
    a -= square / 24.0;
    b -= square / 120.0;
    c += square / 720.0;
  } else {
    a = (1.0 - std::cos(angle)) / square;
    b = (angle - std::sin(angle)) / (square * angle);
    c = (1.0 - 0.5 * angle / std::tan(0.5 * angle)) / square;
  }
  change.to_error += a * S + b * S * S;
  change.of_error += -0.5 * S + c * S * S;
  return change;
}

void linearize_process_factor(const Keyframe& before, const Keyframe& keyframe,
                              LinearProcessFactor* linear) {
  const ProcessFactor& process_factor = keyframe.process_factor;
  linear->F = process_factor.F;
  linear->noise = process_factor.noise;
  linear->offset = process_error(before, keyframe);
  const AttitudeJacobian now =
      attitude_jacobian(keyframe.active, keyframe.state, process_factor.to);
  turn_to_errors(attitude_jacobian(before.active, before.state, process_factor.from), now,
                 &linear->F, &linear->noise);
  if (now.index < 0) return;
  auto offset = linear->offset.segment<3>(now.index);
  offset = (now.to_error * offset).eval();
}

void linearize_prior(const Window& window, EkfCovariance* information, EkfCorrection* gradient) {
  const WindowPrior& prior = window.prior();
  *information = prior.information;
  *gradient = prior.gradient;
  linearize_quadratic(window.at(0), prior.at, information, gradient);
}

void add_process_information(const Keyframe& before, const ProcessFactor& process_factor,
                             EkfCovariance* information, EkfCorrection* gradient) {
  add_joins(before, process_factor.joins, information, gradient);
  if (!process_factor.has_information) return;
  EkfCovariance added = EkfCovariance::Zero(before.active.size(), before.active.size());
  const Eigen::Index core = before.active.core_size();
  added.topLeftCorner(core, core) = process_factor.information;
  EkfCorrection slope = process_factor.gradient;
  linearize_quadratic(before, process_factor.from, &added, &slope);
  *information += added;
  *gradient += slope;
}

}  // namespace leonav
