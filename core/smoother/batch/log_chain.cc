#include "core/smoother/batch/log_chain.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "core/base/square.h"
#include "core/smoother/batch/internal/log_linear.h"

namespace leonav {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A matrix and its inverse by Cholesky, scaled to a unit diagonal.
bool invert(const MatrixXd& matrix, MatrixXd* inverse) {
  const VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return false;
  const Eigen::LLT<MatrixXd> root(scale.asDiagonal() * matrix * scale.asDiagonal());
  if (root.info() != Eigen::Success) return false;
  MatrixXd solved = MatrixXd::Identity(matrix.rows(), matrix.cols());
  root.matrixL().solveInPlace(solved);
  inverse->setZero(matrix.rows(), matrix.cols());
  inverse->selfadjointView<Eigen::Lower>().rankUpdate(solved.transpose());
  inverse->triangularView<Eigen::StrictlyUpper>() = inverse->transpose();
  *inverse = scale.asDiagonal() * *inverse * scale.asDiagonal();
  return inverse->allFinite();
}

// What the forward pass keeps of a keyframe.
struct Step {
  MatrixXd covariance;  // P_k, from all keyframes up to this one and the constraints behind it
  VectorXd error;
  MatrixXd spread;  // T P_(k-1), with T the transition to this keyframe
  MatrixXd predicted_information;
  MatrixXd predicted;  // T P_(k-1) T^T + N
  VectorXd predicted_error;
};

// Where a piece comes from at the keyframe before, as an index of that one's pieces.
struct Origin {
  Index before = -1;  // -1: it begins here
  double added_variance = 0.0, shift_m = 0.0;
};

Origin origin_of(const LogGraph& graph, const LogKeyframe& before, int piece) {
  const auto find = [&](int wanted) {
    const auto found = std::lower_bound(before.pieces.begin(), before.pieces.end(), wanted);
    return found != before.pieces.end() && *found == wanted ? found - before.pieces.begin() : -1;
  };
  Origin origin;
  origin.before = find(piece);
  if (origin.before >= 0) return origin;
  const AmbiguityPiece& self = graph.piece(piece);
  origin.added_variance = self.step_variance;
  if (self.previous >= 0) origin.before = find(self.previous);
  const double expected =
      origin.before >= 0 ? graph.piece(self.previous).value_m : self.start_value_m;
  origin.shift_m = expected - self.value_m;
  return origin;
}

void predict(const LogGraph& graph, int k, const Step& last, Step* step) {
  const LogKeyframe& before = graph.at(k - 1);
  const LogKeyframe& keyframe = graph.at(k);
  const LogLinearProcess process = linearize_process(graph, k);
  const Index core = keyframe.core_size(), core_before = before.core_size();
  const Index size = keyframe.size(), size_before = before.size();
  std::vector<Origin> origins;
  for (const int piece : keyframe.pieces) origins.push_back(origin_of(graph, before, piece));
  step->spread.setZero(size, size_before);
  step->predicted_error.resize(size);
  step->spread.topRows(core).noalias() = process.F * last.covariance.topRows(core_before);
  step->predicted_error.head(core) = process.F * last.error.head(core_before) - process.offset;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const Index row = core + static_cast<Index>(i);
    step->predicted_error(row) = origins[i].shift_m;
    if (origins[i].before < 0) continue;
    step->spread.row(row) = last.covariance.row(core_before + origins[i].before);
    step->predicted_error(row) += last.error(core_before + origins[i].before);
  }
  step->predicted.resize(size, size);
  step->predicted.leftCols(core).noalias() =
      step->spread.leftCols(core_before) * process.F.transpose();
  step->predicted.topLeftCorner(core, core) += process.noise;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const Index column = core + static_cast<Index>(i);
    if (origins[i].before >= 0)
      step->predicted.col(column) = step->spread.col(core_before + origins[i].before);
    else
      step->predicted.col(column).setZero();
    step->predicted(column, column) += origins[i].added_variance;
  }
  step->predicted.topRightCorner(core, size - core) =
      step->predicted.bottomLeftCorner(size - core, core).transpose();
}

bool solve(const LogInformation& sum, Step* step) {
  if (!invert(sum.matrix, &step->covariance)) return false;
  step->error.noalias() = step->covariance * sum.gradient;
  return step->error.allFinite();
}

// The forward estimate of a keyframe lacks what the constraints up to the next say of it.
bool update(const LogGraph& graph, int k, Step* step, LogCorrections* corrections) {
  const Index size = graph.at(k).size();
  LogInformation sum{MatrixXd::Zero(size, size), VectorXd::Zero(size)};
  if (graph.at(k).process.exists) {
    if (!invert(step->predicted, &step->predicted_information)) return false;
    sum.matrix = step->predicted_information;
    sum.gradient.noalias() = step->predicted_information * step->predicted_error;
  } else {
    const LogKeyframe& keyframe = graph.at(k);
    for (std::size_t i = 0; i < keyframe.pieces.size(); ++i) {
      const Index row = keyframe.core_size() + static_cast<Index>(i);
      sum.matrix(row, row) = 1.0 / graph.piece(keyframe.pieces[i]).step_variance;
    }
  }
  add_information(graph, k, &sum);
  if (!solve(sum, step)) return false;
  const Index core = graph.at(k).core_size();
  corrections->filtered_core[static_cast<std::size_t>(k)] = step->error.head(core);
  corrections->filtered_covariance[static_cast<std::size_t>(k)] =
      step->covariance.topLeftCorner(core, core);
  return !add_constraints(graph, k, &sum) || solve(sum, step);
}

}  // namespace

bool solve_chain(const LogGraph& graph, const std::function<void(double)>& progress,
                 LogCorrections* corrections) {
  const int size = graph.size();
  std::vector<Step> steps(static_cast<std::size_t>(size));
  const auto at = [&](int k) -> Step& { return steps[static_cast<std::size_t>(k)]; };
  corrections->core.resize(steps.size());
  corrections->covariance.resize(steps.size());
  corrections->filtered_core.resize(steps.size());
  corrections->filtered_covariance.resize(steps.size());
  corrections->pieces.setZero(static_cast<Index>(graph.pieces().size()));
  for (int k = 0; k < size; ++k) {
    if (graph.at(k).process.exists) predict(graph, k, at(k - 1), &at(k));
    if (!update(graph, k, &at(k), corrections)) return false;
    progress(0.6 * (k + 1) / size);
  }
  VectorXd error;
  MatrixXd covariance;
  for (int k = size - 1; k >= 0; --k) {
    if (k + 1 == size || !graph.at(k + 1).process.exists) {
      error = at(k).error;
      covariance = at(k).covariance;
    } else {
      const Step& next = at(k + 1);
      const MatrixXd gain = next.spread.transpose() * next.predicted_information;
      error = at(k).error + gain * (error - next.predicted_error);
      covariance = at(k).covariance + gain * (covariance - next.predicted) * gain.transpose();
    }
    const LogKeyframe& keyframe = graph.at(k);
    const Index core = keyframe.core_size();
    corrections->core[static_cast<std::size_t>(k)] = error.head(core);
    corrections->covariance[static_cast<std::size_t>(k)] = covariance.topLeftCorner(core, core);
    for (std::size_t i = 0; i < keyframe.pieces.size(); ++i)
      corrections->pieces(keyframe.pieces[i]) = error(core + static_cast<Index>(i));
    progress(1.0 - 0.4 * k / size);
  }
  return true;
}

}  // namespace leonav
