#include "core/smoother/batch/internal/log_linear.h"

#include <algorithm>

#include "core/smoother/linear_process_factor.h"
#include "core/smoother/linearization.h"

namespace leonav {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Adds 0.5 (x - at)^T information (x - at) - gradient^T (x - at) of the core states.
void add_quadratic(const LogKeyframe& keyframe, const CoreState& at, MatrixXd information,
                   VectorXd gradient, LogInformation* sum) {
  const EkfCorrection moved = active_part(keyframe.active, difference(keyframe.state, at));
  turn_to_errors(attitude_jacobian(keyframe.active, keyframe.state, at), moved, &information,
                 &gradient);
  const Index core = keyframe.core_size();
  sum->matrix.topLeftCorner(core, core) += information;
  sum->gradient.head(core) += gradient;
}

// The prior of core states and pieces.
void add_prior(const LogGraph& graph, const LogKeyframe& keyframe, LogInformation* sum) {
  MatrixXd information = keyframe.prior_information;
  VectorXd gradient = keyframe.prior_gradient;
  EkfCorrection moved(keyframe.size());
  moved.head(keyframe.core_size()) =
      active_part(keyframe.active, difference(keyframe.state, keyframe.prior_at));
  for (std::size_t i = 0; i < keyframe.pieces.size(); ++i) {
    const auto piece = static_cast<Index>(i);
    moved(keyframe.core_size() + piece) =
        graph.piece(keyframe.pieces[i]).value_m - keyframe.prior_pieces_at(piece);
  }
  turn_to_errors(attitude_jacobian(keyframe.active, keyframe.state, keyframe.prior_at), moved,
                 &information, &gradient);
  sum->matrix += information;
  sum->gradient += gradient;
}

Index index_of_piece(const LogKeyframe& keyframe, int piece) {
  const auto found = std::lower_bound(keyframe.pieces.begin(), keyframe.pieces.end(), piece);
  return keyframe.core_size() + (found - keyframe.pieces.begin());
}

void add_join(const LogGraph& graph, const LogKeyframe& keyframe, const PieceJoin& join,
              LogInformation* sum) {
  const Index from = index_of_piece(keyframe, join.from), to = index_of_piece(keyframe, join.to);
  const double weight = 1.0 / join.variance;
  const double residual =
      join.difference_m - (graph.piece(join.to).value_m - graph.piece(join.from).value_m);
  sum->matrix(from, from) += weight;
  sum->matrix(to, to) += weight;
  sum->matrix(from, to) -= weight;
  sum->matrix(to, from) -= weight;
  sum->gradient(from) -= weight * residual;
  sum->gradient(to) += weight * residual;
}

}  // namespace

LogLinearProcess linearize_process(const LogGraph& graph, int k) {
  const LogKeyframe& before = graph.at(k - 1);
  const LogKeyframe& keyframe = graph.at(k);
  const LogProcess& process = keyframe.process;
  LogLinearProcess linear{process.F, process.noise, {}};
  linear.offset = active_part(keyframe.active, difference(keyframe.state, process.to));
  linear.offset.noalias() -=
      process.F * active_part(before.active, difference(before.state, process.from));
  const AttitudeJacobian now = attitude_jacobian(keyframe.active, keyframe.state, process.to);
  turn_to_errors(attitude_jacobian(before.active, before.state, process.from), now, &linear.F,
                 &linear.noise);
  if (now.index >= 0)
    linear.offset.segment<3>(now.index) =
        (now.to_error * linear.offset.segment<3>(now.index)).eval();
  return linear;
}

LinearMeasurement linearize(const LogGraph& graph, const LogKeyframe& keyframe,
                            const LogMeasurement& measurement, const AntennaMotion& antenna) {
  LinearMeasurement linear = linearize(measurement.measurement,
                                       keyframe.satellites[measurement.measurement.satellite_index],
                                       keyframe.state, antenna);
  if (measurement.piece >= 0)
    linear.residual -= graph.piece(measurement.piece).value_m + measurement.ambiguity_offset_m;
  return linear;
}

void add_information(const LogGraph& graph, int k, LogInformation* sum) {
  const LogKeyframe& keyframe = graph.at(k);
  const Index core = keyframe.core_size();
  if (keyframe.prior_information.size() > 0) add_prior(graph, keyframe, sum);
  const AntennaMotion antenna = antenna_of(keyframe, keyframe.state, graph.lever_arm_b());
  VectorXd row(core);
  for (const LogMeasurement& measurement : keyframe.measurements) {
    const double weight = measurement.factor / measurement.gain_variance;
    if (!(weight > 0.0)) continue;
    const LinearMeasurement linear = linearize(graph, keyframe, measurement, antenna);
    for (Index i = 0; i < core; ++i)
      row(i) = row_of(linear, keyframe.active.core[static_cast<std::size_t>(i)]);
    for (Index j = 0; j < core; ++j)
      if (row(j) != 0.0) sum->matrix.col(j).head(core) += (weight * row(j)) * row;
    sum->gradient.head(core) += weight * linear.residual * row;
    if (measurement.piece < 0) continue;
    const Index piece = index_of_piece(keyframe, measurement.piece);
    sum->matrix.row(piece).head(core) += weight * row.transpose();
    sum->matrix.col(piece).head(core) += weight * row;
    sum->matrix(piece, piece) += weight;
    sum->gradient(piece) += weight * linear.residual;
  }
}

bool add_constraints(const LogGraph& graph, int k, LogInformation* sum) {
  if (k + 1 == graph.size()) return false;
  const LogProcess& process = graph.at(k + 1).process;
  if (process.information.size() > 0)
    add_quadratic(graph.at(k), process.from, process.information, process.gradient, sum);
  for (const PieceJoin& join : process.joins) add_join(graph, graph.at(k), join, sum);
  return process.information.size() > 0 || !process.joins.empty();
}

}  // namespace leonav
